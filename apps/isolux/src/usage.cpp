#include "usage.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/options.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace isolux {
namespace {

std::string guess(const std::string& word, const CLI::App& app) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  // A beginning is meant for the whole, not for something shorter that is fewer letters away.
  const auto begun = [&](const std::string& name) { return word.size() > 2 && name.starts_with(word); };
  const auto whole = std::find_if(known.begin(), known.end(), begun);
  const std::string near = whole != known.end() ? *whole : nearest_word(word, known);
  return near.empty() ? "" : fmt::format(" (did you mean {}?)", near);
}

std::optional<double> number(const std::string& text) {
  try {
    return parse_number("", text);
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

std::string refusal(const std::string& text, const std::string& allowed) {
  return fmt::format("'{}': allowed is {}", text, allowed);
}

}  // namespace

std::string explain(const CLI::ParseError& error, const CLI::App& app) {
  std::string why = error.what();
  const bool unknown = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const bool missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (!unknown && !missing) return why;
  for (const auto& word : app.remaining()) {
    const std::string near = guess(word, app);
    if (unknown) why += near;
    // What is missing may be there, misspelt.
    if (missing && word.starts_with('-') && word != "--") why += fmt::format("; not known is {}{}", word, near);
  }
  return why;
}

std::string word_without_value(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;  // behind it words are no options
    if (word.starts_with('-') && word.find('=') == word.size() - 1) return word;
  }
  return "";
}

TextCheck above_zero() {
  return [](const std::string& text) {
    const auto value = number(text);
    return value && *value > 0.0 ? "" : refusal(text, "a number above 0");
  };
}

TextCheck number_within(double low, double high) {
  return [low, high](const std::string& text) {
    const auto value = number(text);
    return value && *value >= low && *value <= high ? ""
                                                    : refusal(text, fmt::format("a number from {} to {}", low, high));
  };
}

TextCheck finite_number() {
  return [](const std::string& text) {
    const auto value = number(text);
    return value && std::isfinite(float(*value)) ? "" : refusal(text, "a number from -3.4e38 to 3.4e38");
  };
}

CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  const auto to_decimal = [low, high](std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
    const bool good = error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
    if (!good) return refusal(text, fmt::format("a whole number from {} to {}", low, high));
    text = std::to_string(value);
    return "";
  };
  return {to_decimal, fmt::format("{} to {}", low, high)};
}

TextCheck key_and_value() {
  return [](const std::string& text) {
    const auto equals = text.find('=');
    if (equals != std::string::npos && equals > 0) return std::string();
    return refusal(text, "key=value; other arguments go before --set or behind another option");
  };
}

TextCheck something() {
  return [](const std::string& text) { return text.empty() ? "'': a value is missing" : ""; };
}

}  // namespace isolux
