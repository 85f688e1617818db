#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace isolux {

/// Option texts as a user gives them, by key: {"k", "11"}.
using Settings = std::map<std::string, std::string, std::less<>>;

/// What a describe() says of an option besides its name and variable. Numbers outside [min, max] are refused.
struct OptionNote {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string_view unit{};
  std::string_view help{};
};

/// One option as `isolux backends`, `--set` help and the viewer's sliders show it.
struct OptionInfo {
  std::string name;
  std::string type;  ///< "int", "number", "bool", "text" or "choice"
  std::string default_value;
  double min = 0.0;  ///< of numbers; infinite where open
  double max = 0.0;
  std::vector<std::string> choices;  ///< of choices
  std::string unit;
  std::string help;

  /// "1..512", "at least 0", "euclidean | chebyshev", "true | false", "any text", "any number".
  [[nodiscard]] std::string allowed() const;
};

/// Visits the options of a struct whose `void describe(OptionVisitor& option)` calls option(name, variable, note) once
/// for each. Collects their descriptions and, where `settings` names one, parses and assigns it.
class OptionVisitor {
 public:
  explicit OptionVisitor(std::string owner, const Settings* settings = nullptr)
      : owner_(std::move(owner)), settings_(settings) {}

  void operator()(std::string_view name, int& variable, const OptionNote& note);
  void operator()(std::string_view name, double& variable, const OptionNote& note);
  void operator()(std::string_view name, bool& variable, const OptionNote& note);
  /// Any text, as it is.
  void operator()(std::string_view name, std::string& variable, const OptionNote& note);
  /// An enumeration and its words.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(std::string_view name, Enum& variable, const std::vector<std::pair<std::string, Enum>>& words,
                  const OptionNote& note) {
    std::vector<std::string> choices;
    std::size_t current = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
      choices.push_back(words[i].first);
      if (words[i].second == variable) current = i;
    }
    variable = words.at(choose(name, current, choices, note)).second;
  }

  [[nodiscard]] const std::vector<OptionInfo>& options() const { return options_; }
  /// \throw InvalidInput if `settings` held a key that describe() never named; it says which keys exist and the
  /// nearest.
  void require_all_used() const;

 private:
  [[nodiscard]] const std::string* given(std::string_view name) const;
  OptionInfo& note(std::string_view name, std::string_view type, std::string default_value, const OptionNote& note);
  std::size_t choose(std::string_view name, std::size_t current, const std::vector<std::string>& choices,
                     const OptionNote& note);

  std::string owner_;  ///< "resampler shepard", for messages
  const Settings* settings_;
  std::vector<OptionInfo> options_;
};

/// `Options{}` with `settings` applied. \throw InvalidInput for unknown keys, wrong types and values out of range.
template <class Options>
[[nodiscard]] Options parse_options(const std::string& owner, const Settings& settings) {
  Options options;
  OptionVisitor visitor(owner, &settings);
  options.describe(visitor);
  visitor.require_all_used();
  return options;
}

/// The options of a struct with their defaults.
template <class Options>
[[nodiscard]] std::vector<OptionInfo> describe_options() {
  Options options;
  OptionVisitor visitor("");
  options.describe(visitor);
  return visitor.options();
}

/// For backends that have none.
struct NoOptions {
  void describe(OptionVisitor& /*option*/) {}
};

/// The one of `known` nearest to `word` by edit distance; "" if none is near. For "did you mean".
[[nodiscard]] std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// The whole text as a number. \throw InvalidInput naming `what` otherwise, or if it is not finite.
[[nodiscard]] double parse_number(std::string_view what, std::string_view text);

}  // namespace isolux
