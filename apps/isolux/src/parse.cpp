#include "parse.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/core/options.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "session.h"

namespace isolux {
namespace {

std::optional<int> whole(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// One of the numbers of `text`; the message shows it all, as it was given.
double number(const std::string& option, const std::string& part, const std::string& text, const std::string& allowed) {
  try {
    return parse_number(option, part);
  } catch (const InvalidInput&) {
    throw UsageError(fmt::format("{} = '{}': '{}' is no finite number; allowed {}", option, text, part, allowed));
  }
}

std::vector<int> sizes(const std::string& option, const std::string& text, std::size_t count, const char* pattern) {
  std::vector<int> result;
  for (const auto& part : split(text, 'x')) {
    const auto value = whole(part);
    if (value && *value >= 1) result.push_back(*value);
  }
  if (result.size() != count || split(text, 'x').size() != count) {
    throw UsageError(fmt::format("{} = '{}': allowed is {}, whole numbers of at least 1", option, text, pattern));
  }
  return result;
}

}  // namespace

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

Index3 parse_size3(const std::string& option, const std::string& text, const char* pattern) {
  const auto s = sizes(option, text, 3, pattern);
  return {s[0], s[1], s[2]};
}

std::pair<int, int> parse_size2(const std::string& option, const std::string& text) {
  const auto s = sizes(option, text, 2, "WxH");
  return {s[0], s[1]};
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count) {
  const std::string allowed = count == 1 ? "is a number" : fmt::format("are {} numbers with commas between", count);
  std::vector<double> numbers;
  for (const auto& part : split(text, ',')) numbers.push_back(number(option, part, text, allowed));
  if (numbers.size() != count) throw UsageError(fmt::format("{} = '{}': allowed {}", option, text, allowed));
  return numbers;
}

int parse_bounces(const std::string& text) {
  if (text == "all") return kAllBounces;
  const auto value = whole(text);
  if (!value || *value < 0)
    throw UsageError(fmt::format("--bounces = '{}': allowed is 'all' or a whole number from 0 to {}", text,
                                 std::numeric_limits<int>::max()));
  return *value;
}

void apply_settings(const std::string& option, const std::vector<std::string>& texts,
                    const std::vector<std::pair<std::string, Settings*>>& targets) {
  std::vector<std::string> names;
  for (const auto& [name, settings] : targets) names.push_back(name);
  for (const auto& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError(fmt::format("{} '{}': allowed is {}key=value", option, text, targets.size() > 1 ? "NAME." : ""));
    }
    std::string key = text.substr(0, equals);
    Settings* settings = targets.size() == 1 ? targets[0].second : nullptr;
    if (const auto dot = key.find('.'); dot != std::string::npos) {
      const std::string stage = key.substr(0, dot);
      key.erase(0, dot + 1);
      settings = nullptr;
      for (const auto& target : targets) {
        if (target.first == stage) settings = target.second;
      }
    }
    if (settings == nullptr)
      throw UsageError(
          fmt::format("{} '{}': the name before the point is one of {}", option, text, fmt::join(names, ", ")));
    if (!settings->emplace(key, text.substr(equals + 1)).second)
      throw UsageError(fmt::format("{} '{}': {} is given twice", option, text, text.substr(0, equals)));
  }
}

}  // namespace isolux
