#include "gl/read_pixels.h"

#include <epoxy/gl.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace isolux::viewer {
namespace {

/// The inverse of the sRGB curve (IEC 61966-2-1).
float linear(int code) {
  const double v = code / 255.0;
  return float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
}

}  // namespace

Image read_pixels(int width, int height) {
  std::vector<std::array<std::uint8_t, 3>> codes(std::size_t(width) * std::size_t(height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, codes.data());
  std::array<float, 256> table{};
  for (int code = 0; code < 256; ++code) table[std::size_t(code)] = linear(code);
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    // OpenGL's first row is the lowest.
    const auto* row = codes.data() + std::size_t(height - 1 - y) * std::size_t(width);
    for (int x = 0; x < width; ++x) image.at(x, y) = {table[row[x][0]], table[row[x][1]], table[row[x][2]]};
  }
  return image;
}

}  // namespace isolux::viewer
