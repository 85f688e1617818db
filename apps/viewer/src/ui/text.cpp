#include "ui/text.h"

#include <stb_easy_font.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace isolux::viewer {
namespace {

/// Letters for U+00C0 to U+017F, the accented ones of Latin, with '?' for what is no letter.
constexpr std::string_view kPlainLetters =
    "AAAAAAACEEEEIIIIDNOOOOO?OUUUUYTsaaaaaaaceeeeiiiidnooooo?ouuuuyty"
    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlL"
    "lLlNnNnNnnNnOoOoOoOoRrRrRrSsSsSsSsTtTtTtUuUuUuUuUuUuWwYyYZzZzZzs";
static_assert(kPlainLetters.size() == 0x180 - 0xC0);

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// The font's table has ASCII alone; beyond it stb_easy_font would read elsewhere. A byte that is no UTF-8 is a '?'.
std::string ascii(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n' || (c >= ' ' && c <= '~')) {
      result += c;
      continue;
    }
    const auto first = static_cast<unsigned char>(c);
    const bool long_enough = first >= 0xC0 && i + 1 < text.size() && continues(text[i + 1]);
    if (!long_enough) {
      result += '?';
      continue;
    }
    const std::size_t code = std::size_t(first & 0x1F) << 6 | (static_cast<unsigned char>(text[i + 1]) & 0x3F);
    while (i + 1 < text.size() && continues(text[i + 1])) ++i;
    const bool two_bytes = first < 0xE0;
    if (two_bytes && code >= 0x300 && code < 0x370) continue;  // accents behind their letters, as macOS has them
    const bool letter = two_bytes && code >= 0xC0 && code - 0xC0 < kPlainLetters.size();
    result += letter ? kPlainLetters[code - 0xC0] : '?';
  }
  return result;
}

struct FontVertex {
  float x, y, z;
  std::array<unsigned char, 4> colour;
};

}  // namespace

std::vector<Box> text_boxes(std::string_view text) {
  std::string letters = ascii(text);
  // Fewer than 32 strokes a character, 4 corners a stroke.
  std::vector<FontVertex> corners(letters.size() * 32 * 4);
  const int count = stb_easy_font_print(0.0f, 0.0f, letters.data(), nullptr, corners.data(),
                                        int(corners.size() * sizeof(FontVertex)));
  std::vector<Box> boxes;
  boxes.reserve(std::size_t(count));
  for (std::size_t q = 0; q < std::size_t(count); ++q) {
    const FontVertex& low = corners[4 * q];
    const FontVertex& high = corners[4 * q + 2];
    boxes.push_back({low.x, low.y, double(high.x) - low.x, double(high.y) - low.y});
  }
  return boxes;
}

double text_width(std::string_view text) {
  std::string letters = ascii(text);
  return stb_easy_font_width(letters.data());
}

std::string wrap_text(std::string_view text, double most) {
  const std::string letters = ascii(text);
  std::string result;
  std::string line;
  const auto end_line = [&] {
    result += line + '\n';
    line.clear();
  };
  for (const char c : letters) {
    if (c == '\n') {
      end_line();
      continue;
    }
    if (!line.empty() && text_width(line + c) > most) {
      const std::size_t space = line.rfind(' ');
      std::string rest = c == ' ' || space == std::string::npos ? "" : line.substr(space + 1);
      if (c != ' ' && space != std::string::npos) line.resize(space);
      end_line();
      line = std::move(rest);
      if (c == ' ') continue;
    }
    line += c;
  }
  return result + line;
}

}  // namespace isolux::viewer
