#include "usage.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/options.h>

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
  const std::string near = nearest_word(word, known);
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
    if (missing && word.starts_with('-')) why += fmt::format("; not known is {}{}", word, near);
  }
  return why;
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
    return value && std::isfinite(float(*value)) ? "" : refusal(text, "a finite number");
  };
}

TextCheck seed_number() {
  return [](const std::string& text) {
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    const bool good = error == std::errc() && end == text.data() + text.size();
    return good ? "" : refusal(text, "a whole number from 0 to 18446744073709551615");
  };
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
