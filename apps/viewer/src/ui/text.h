#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ui/box.h"

namespace isolux::viewer {

/// Height of a line of text, pixels at size 1.
inline constexpr double kLineHeight = 12.0;

/// The strokes of a text as rectangles, pixels at size 1 from its top left corner (the font of stb_easy_font). Newlines
/// are kept, accented letters of UTF-8 lose their accents, and other characters outside ASCII become '?'.
[[nodiscard]] std::vector<Box> text_boxes(std::string_view text);

/// Width of the longest line, pixels at size 1.
[[nodiscard]] double text_width(std::string_view text);

/// The text with newlines where lines would be wider than `most`, pixels at size 1: between words, or within one that
/// is too long for a line of its own.
[[nodiscard]] std::string wrap_text(std::string_view text, double most);

}  // namespace isolux::viewer
