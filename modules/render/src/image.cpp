#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/render/image.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <limits>
#include <new>

#include <stb/stb_image_write.h>

namespace isolux {

std::uint8_t srgb_code(float linear) {
  if (!(linear > 0.0f)) return 0;
  const float v = std::min(linear, 1.0f);
  const float encoded = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
  return std::uint8_t(std::lround(encoded * 255.0f));
}

float linear_value(std::uint8_t code) {
  const float v = float(code) / 255.0f;
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

namespace {

/// \throw InvalidInput
std::size_t pixel_count(int width, int height) {
  constexpr std::size_t kMost = std::size_t(1) << 48;  // as of a lattice: what addresses reach
  const std::size_t count = width >= 0 && height >= 0 ? std::size_t(width) * std::size_t(height) : kMost + 1;
  if (count <= kMost) return count;
  throw InvalidInput(
      fmt::format("a picture of {}x{} pixels: allowed are sizes of 0 and more, and 2^48 pixels", width, height));
}

}  // namespace

Image::Image(int columns, int rows, const Vec3f& colour)
    : width(columns), height(rows), pixels(pixel_count(columns, rows), colour) {}

void require_png_size(int width, int height, int channels) {
  // Where stb counts bytes in an int that it doubles.
  constexpr double kMostBytes = 1 << 30;
  if ((double(channels) * width + 1.0) * height > kMostBytes)
    throw InvalidInput(fmt::format("a picture of {}x{} pixels: allowed are {:.0f} million in all", width, height,
                                   kMostBytes / (1e6 * channels)));
}

namespace {

/// \throw InvalidInput
void require_pixels(const Image& image, const std::string& path) {
  const std::size_t pixels = image.pixels.size();
  const bool is_whole = image.width >= 1 && image.height >= 1 &&
                        pixels == std::size_t(image.width) * std::size_t(image.height) &&
                        (image.coverage.empty() || image.coverage.size() == pixels);
  if (!is_whole)
    throw InvalidInput(fmt::format("{}: {} pixels, {} with coverage, for a picture of {}x{}", path, pixels,
                                   image.coverage.size(), image.width, image.height));
}

}  // namespace

void write_png(const Image& image, const std::string& path) {
  const int channels = image.coverage.empty() ? 3 : 4;
  require_png_size(image.width, image.height, channels);
  require_pixels(image, path);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * std::size_t(channels));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) bytes.push_back(srgb_code(image.pixels[i][c]));
    if (channels == 4) bytes.push_back(std::uint8_t(std::lround(255.0f * std::clamp(image.coverage[i], 0.0f, 1.0f))));
  }
  // By way of memory: stb's own files do not notice a full disk.
  std::string png;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), std::size_t(size));
  };
  const bool made = stbi_write_png_to_func(append, &png, image.width, image.height, channels, bytes.data(),
                                           image.width * channels) != 0;
  if (!made) throw std::bad_alloc();  // all else was checked
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(png.data(), std::streamsize(png.size()));
  file.close();
  if (!file) throw IoError(fmt::format("{}: writing failed: {}", path, reason_of(errno)));
}

namespace {

/// Copies a picture into a larger one, its left edge at column `at`.
void put(const Image& from, int at, Image& into) {
  for (int y = 0; y < from.height; ++y) {
    std::copy_n(&from.at(0, y), from.width, &into.at(at, y));
    if (into.coverage.empty()) continue;
    float* const row = &into.coverage[into.offset(at, y)];
    if (from.coverage.empty())
      std::fill_n(row, from.width, 1.0f);
    else
      std::copy_n(&from.coverage[from.offset(0, y)], from.width, row);
  }
}

}  // namespace

Image side_by_side(const Image& left, const Image& right, int gap, const Vec3f& colour) {
  if (gap < 0) throw InvalidInput(fmt::format("a gap of {} pixels: allowed is 0 and more", gap));
  const std::int64_t width = std::int64_t(left.width) + gap + right.width;
  if (width > std::numeric_limits<int>::max())
    throw InvalidInput(fmt::format("pictures of {} and {} pixels with {} between: allowed are 2^31 - 1 in all",
                                   left.width, right.width, gap));
  Image both(int(width), std::max(left.height, right.height), colour);
  if (!left.coverage.empty() || !right.coverage.empty()) both.coverage.assign(both.pixels.size(), 0.0f);
  put(left, 0, both);
  put(right, left.width + gap, both);
  return both;
}

}  // namespace isolux
