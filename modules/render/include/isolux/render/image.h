#pragma once

#include <isolux/core/vec.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace isolux {

/// A picture in linear radiance, RGB, row 0 at the top, x fastest.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Vec3f> pixels;
  std::vector<float> coverage{};  ///< how much of each pixel is covered by its colour, 0 to 1; empty: all of all

  Image() = default;
  /// \throw InvalidInput for sizes below 0 and more than 2^48 pixels
  Image(int columns, int rows, const Vec3f& colour = Vec3f(0.0f));
  [[nodiscard]] std::size_t offset(int x, int y) const { return std::size_t(y) * std::size_t(width) + std::size_t(x); }
  [[nodiscard]] Vec3f& at(int x, int y) { return pixels[offset(x, y)]; }
  [[nodiscard]] const Vec3f& at(int x, int y) const { return pixels[offset(x, y)]; }
};

/// A linear value as an 8-bit sRGB code (IEC 61966-2-1), clamped to 0..255; NaN gives 0.
[[nodiscard]] std::uint8_t srgb_code(float linear);

/// The linear value that an 8-bit sRGB code stands for.
[[nodiscard]] float linear_value(std::uint8_t code);

/// For finding out before the work that write_png would refuse so many pixels of 3 channels, or of 4 with coverage.
/// \throw InvalidInput
void require_png_size(int width, int height, int channels = 3);

/// Writes 8-bit sRGB PNG, with an alpha channel (straight, not premultiplied) where the image has coverage. \throw
/// IoError naming path; InvalidInput for no pixels, other numbers of them or of their coverage than width times height,
/// or more than 357 million (268 with coverage)
void write_png(const Image& image, const std::string& path);

/// Two pictures side by side, tops aligned, with a gap of `gap` pixels in `colour`, which also fills up the lower one;
/// transparent instead if either has coverage. \throw InvalidInput for a negative gap, or a
/// picture wider than int holds
[[nodiscard]] Image side_by_side(const Image& left, const Image& right, int gap, const Vec3f& colour);

}  // namespace isolux
