#pragma once

#include <isolux/bake/bake.h>
#include <isolux/core/volume.h>

#include <string>
#include <vector>

namespace isolux {

/// Readers of option values; each throws UsageError naming the option, the text and what is allowed.

/// The parts between separators: one more than there are separators.
[[nodiscard]] std::vector<std::string> split(const std::string& text, char separator);
/// "64x64x32": whole numbers of at least 1. `pattern` says what is allowed.
[[nodiscard]] Index3 parse_size3(const std::string& option, const std::string& text, const char* pattern = "NXxNYxNZ");
/// "800x600"
[[nodiscard]] std::pair<int, int> parse_size2(const std::string& option, const std::string& text);
/// "a,b,c" with `count` finite numbers
[[nodiscard]] std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count);
/// "all" or a whole number of at least 0
[[nodiscard]] int parse_bounces(const std::string& text);

/// Puts the `NAME.key=value` of an option where they belong; NAME is one of the names in `targets`, and may be left out
/// if there is one.
void apply_settings(const std::string& option, const std::vector<std::string>& texts,
                    const std::vector<std::pair<std::string, Settings*>>& targets);

}  // namespace isolux
