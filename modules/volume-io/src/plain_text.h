#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace isolux::detail {

/// Words separated by blanks.
[[nodiscard]] std::vector<std::string> plain_words(std::string_view text);
/// The first of them alone; empty if there is none.
[[nodiscard]] std::string_view first_word(std::string_view text);

[[nodiscard]] bool is_digit(char c);
[[nodiscard]] std::string lower_case(std::string_view text);

/// What a message shows of text that may be long, or binary rubbish.
[[nodiscard]] std::string excerpt(std::string_view text);

}  // namespace isolux::detail
