#include "ui/text.h"

#include <stb_easy_font.h>

#include <array>
#include <string>

namespace isolux::viewer {
namespace {

/// The font's table has ASCII alone; beyond it stb_easy_font would read elsewhere.
std::string ascii(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c != '\n' && (c < ' ' || c > '~')) c = '?';
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

}  // namespace isolux::viewer
