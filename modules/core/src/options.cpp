#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/core/options.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>

namespace isolux {
namespace {

std::string number_text(double x) { return fmt::format("{}", x); }

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// The whole text as a number; nothing if it is none.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
  // from_chars takes no plus sign, but people and programs write one.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const std::string& owner, const OptionInfo& option, std::string_view given) {
  throw InvalidInput(fmt::format("{}{}{} = '{}': allowed is {}", owner, owner.empty() ? "" : ": ", option.name, given,
                                 option.allowed()));
}

}  // namespace

std::string OptionInfo::allowed() const {
  if (type == "choice") return fmt::format("{}", fmt::join(choices, " | "));
  if (type == "bool") return "true | false";
  if (type == "text") return "any text";
  const std::string kind = type == "int" ? "whole number" : "number";
  if (std::isinf(min) && std::isinf(max)) return "any " + kind;
  if (std::isinf(max)) return fmt::format("a {} of at least {}", kind, number_text(min));
  if (std::isinf(min)) return fmt::format("a {} of at most {}", kind, number_text(max));
  return fmt::format("a {} from {} to {}", kind, number_text(min), number_text(max));
}

const std::string* OptionVisitor::given(std::string_view name) const {
  if (settings_ == nullptr) return nullptr;
  const auto it = settings_->find(name);
  return it == settings_->end() ? nullptr : &it->second;
}

OptionInfo& OptionVisitor::note(std::string_view name, std::string_view type, std::string default_value,
                                const OptionNote& text) {
  options_.push_back({.name = std::string(name),
                      .type = std::string(type),
                      .default_value = std::move(default_value),
                      .min = text.min,
                      .max = text.max,
                      .choices = {},
                      .unit = std::string(text.unit),
                      .help = std::string(text.help)});
  return options_.back();
}

void OptionVisitor::operator()(std::string_view name, int& variable, const OptionNote& text) {
  const OptionInfo& option = note(name, "int", std::to_string(variable), text);
  if (const std::string* words = given(name)) {
    const auto value = number_of<int>(*words);
    if (!value || *value < option.min || *value > option.max) refuse(owner_, option, *words);
    variable = *value;
  }
}

void OptionVisitor::operator()(std::string_view name, double& variable, const OptionNote& text) {
  const OptionInfo& option = note(name, "number", number_text(variable), text);
  if (const std::string* words = given(name)) {
    const auto value = number_of<double>(*words);
    if (!value || !std::isfinite(*value) || *value < option.min || *value > option.max) refuse(owner_, option, *words);
    variable = *value;
  }
}

void OptionVisitor::operator()(std::string_view name, bool& variable, const OptionNote& text) {
  const OptionInfo& option = note(name, "bool", variable ? "true" : "false", text);
  if (const std::string* words = given(name)) {
    if (*words != "true" && *words != "false") refuse(owner_, option, *words);
    variable = *words == "true";
  }
}

void OptionVisitor::operator()(std::string_view name, std::string& variable, const OptionNote& text) {
  note(name, "text", variable, text);
  if (const std::string* words = given(name)) variable = *words;
}

std::size_t OptionVisitor::choose(std::string_view name, std::size_t current, const std::vector<std::string>& choices,
                                  const OptionNote& text) {
  OptionInfo& option = note(name, "choice", choices[current], text);
  option.choices = choices;
  const std::string* words = given(name);
  if (words == nullptr) return current;
  const auto it = std::find(choices.begin(), choices.end(), *words);
  if (it == choices.end()) refuse(owner_, option, *words);
  return std::size_t(it - choices.begin());
}

void OptionVisitor::require_all_used() const {
  if (settings_ == nullptr) return;
  std::vector<std::string> names;
  for (const auto& option : options_) names.push_back(option.name);
  for (const auto& [key, value] : *settings_) {
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    if (names.empty()) throw InvalidInput(fmt::format("{} has no options; '{}' was given", owner_, key));
    const std::string near = nearest_word(key, names);
    throw InvalidInput(fmt::format("{} has no option '{}'{}; it has {}", owner_, key,
                                   near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near),
                                   fmt::join(names, ", ")));
  }
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const auto& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

double parse_number(std::string_view what, std::string_view text) {
  const auto value = number_of<double>(text);
  if (!value || !std::isfinite(*value))
    throw InvalidInput(fmt::format("{} = '{}': allowed is a finite number", what, text));
  return *value;
}

}  // namespace isolux
