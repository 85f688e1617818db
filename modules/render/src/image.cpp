#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/render/image.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <new>

#include <stb/stb_image_write.h>

namespace isolux {

std::uint8_t srgb_code(float linear) {
  if (!(linear > 0.0f)) return 0;
  const float v = std::min(linear, 1.0f);
  const float encoded = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
  return std::uint8_t(std::lround(encoded * 255.0f));
}

void require_png_size(int width, int height) {
  // Where stb counts bytes in an int that it doubles.
  constexpr double kMostBytes = 1 << 30;
  if ((3.0 * width + 1.0) * height > kMostBytes)
    throw InvalidInput(
        fmt::format("a picture of {}x{} pixels: allowed are {:.0f} million in all", width, height, kMostBytes / 3e6));
}

void write_png(const Image& image, const std::string& path) {
  require_png_size(image.width, image.height);
  if (image.width < 1 || image.height < 1 ||
      image.pixels.size() != std::size_t(image.width) * std::size_t(image.height))
    throw InvalidInput(
        fmt::format("{}: {} pixels for a picture of {}x{}", path, image.pixels.size(), image.width, image.height));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 3);
  for (const Vec3f& p : image.pixels) {
    for (int c = 0; c < 3; ++c) bytes.push_back(srgb_code(p[c]));
  }
  // By way of memory: stb's own files do not notice a full disk.
  std::string png;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), std::size_t(size));
  };
  const bool made =
      stbi_write_png_to_func(append, &png, image.width, image.height, 3, bytes.data(), image.width * 3) != 0;
  if (!made) throw std::bad_alloc();  // all else was checked
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(png.data(), std::streamsize(png.size()));
  file.close();
  if (!file) throw IoError(fmt::format("{}: writing failed: {}", path, reason_of(errno)));
}

Image side_by_side(const Image& left, const Image& right, int gap, const Vec3f& colour) {
  if (gap < 0) throw InvalidInput(fmt::format("a gap of {} pixels: allowed is 0 and more", gap));
  Image both(left.width + gap + right.width, std::max(left.height, right.height), colour);
  for (int y = 0; y < left.height; ++y) std::copy_n(&left.at(0, y), left.width, &both.at(0, y));
  for (int y = 0; y < right.height; ++y) std::copy_n(&right.at(0, y), right.width, &both.at(left.width + gap, y));
  return both;
}

}  // namespace isolux
