#include <fmt/format.h>
#include <isolux/bake/scene_file.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>

#include <stb/stb_image.h>

#include "exr_image.h"
#include "radiance_header.h"

namespace isolux {
namespace {

/// A file for stb that notes when more is asked than there is: of a Radiance HDR that ends early stb makes the rest
/// black and says nothing, or waits for ever for a run that is not empty.
class StbFile {
 public:
  /// `beyond`: the byte that stands for all those behind the end, if any; -1 ends the file as usual.
  StbFile(const std::string& path, int beyond) : file_(path, std::ios::binary), beyond_(beyond) {}

  [[nodiscard]] bool ended_early() const { return ended_early_; }
  static const stbi_io_callbacks& callbacks() {
    static const stbi_io_callbacks calls{
        [](void* user, char* into, int count) { return static_cast<StbFile*>(user)->read(into, count); },
        [](void* user, int count) { static_cast<StbFile*>(user)->skip(count); },
        [](void* user) { return static_cast<StbFile*>(user)->at_end() ? 1 : 0; }};
    return calls;
  }

 private:
  int read(char* into, int count) {
    file_.read(into, count);
    const auto got = int(file_.gcount());
    if (got > 0) return got;
    ended_early_ = true;
    if (beyond_ < 0) return 0;
    std::fill_n(into, count, char(beyond_));
    return count;
  }
  void skip(int count) {
    file_.clear();
    file_.seekg(count, std::ios::cur);
  }
  bool at_end() { return file_.peek() == std::ifstream::traits_type::eof(); }

  std::ifstream file_;
  int beyond_;
  bool ended_early_ = false;
};

/// stb takes PGM and PPM of 16 bits for little endian, and greys among them for pixels of 8 bits, of which half as many
/// bytes are there. \throw InvalidInput
void refuse_wide_pnm(const std::string& path) {
  char magic[2] = {};
  std::ifstream(path, std::ios::binary).read(magic, 2);
  if (magic[0] == 'P' && (magic[1] == '5' || magic[1] == '6') && stbi_is_16_bit(path.c_str()) != 0)
    throw InvalidInput(fmt::format("{}: PGM and PPM of 16 bits are not supported; PNG of 16 bits is", path));
}

/// \throw IoError for pixels that no code makes of so few bytes: stb would take memory and time for all of them first.
void require_pixels_in_file(const std::string& path) {
  constexpr std::uint64_t kMostAByte = 8 * 1032;  // bits are pixels in PNG, of which deflate makes 1032 of one at most
  const std::uint64_t bytes = std::filesystem::file_size(path);
  int width = 0;
  int height = 0;
  if (stbi_info(path.c_str(), &width, &height, nullptr) == 0) return;  // whoever reads it says why
  if (std::uint64_t(width) * std::uint64_t(height) / kMostAByte > bytes)
    throw IoError(fmt::format("{}: the image ends early: {} bytes for {}x{} pixels", path, bytes, width, height));
}

/// Radiance HDR as it was measured; 8-bit formats from sRGB, exactly (stb's own conversion is a plain power).
ImageEnvironment read_with_stb(const std::string& path) {
  const auto srgb_to_linear = [](float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  };
  refuse_wide_pnm(path);
  require_pixels_in_file(path);
  ImageEnvironment image;
  int channels = 0;
  const bool hdr = stbi_is_hdr(path.c_str()) != 0;
  StbFile file(path, hdr ? 0xFF : -1);  // a run of 127 equal values, which no scanline waits for twice
  const auto require = [&](bool read) {
    if (!read)
      throw IoError(fmt::format("{}: cannot read the image: {}{}", path, stbi_failure_reason(),
                                file.ended_early() ? " (the image ends early)" : ""));
    if (file.ended_early()) throw IoError(fmt::format("{}: the image ends early", path));
  };
  if (hdr) {
    const Vec3 exposure = radiance_exposure(path);
    const std::unique_ptr<float, void (*)(void*)> data(
        stbi_loadf_from_callbacks(&StbFile::callbacks(), &file, &image.width, &image.height, &channels, 3),
        stbi_image_free);
    require(data != nullptr);
    const float* p = data.get();
    for (std::ptrdiff_t i = 0; i < std::ptrdiff_t(image.width) * image.height; ++i, p += 3)
      image.pixels.emplace_back(Vec3(p[0], p[1], p[2]) / exposure);
    return image;
  }
  const std::unique_ptr<stbi_us, void (*)(void*)> data(
      stbi_load_16_from_callbacks(&StbFile::callbacks(), &file, &image.width, &image.height, &channels, 3),
      stbi_image_free);
  require(data != nullptr);
  const stbi_us* p = data.get();
  for (std::ptrdiff_t i = 0; i < std::ptrdiff_t(image.width) * image.height; ++i, p += 3) {
    image.pixels.emplace_back(srgb_to_linear(float(p[0]) / 65535.0f), srgb_to_linear(float(p[1]) / 65535.0f),
                              srgb_to_linear(float(p[2]) / 65535.0f));
  }
  return image;
}

}  // namespace

ImageEnvironment read_environment_image(const std::string& path) {
  std::error_code error;
  if (!std::ifstream(path, std::ios::binary) || !std::filesystem::is_regular_file(path, error))
    throw IoError(fmt::format("{}: cannot open the environment image: is it a file?", path));
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  ImageEnvironment image = extension == ".exr" ? read_exr_image(path) : read_with_stb(path);
  if (image.pixels.empty())
    throw InvalidInput(
        fmt::format("{}: an image of {}x{} pixels; at least one is needed", path, image.width, image.height));
  for (const Vec3f& p : image.pixels) {
    if (!(p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f && std::isfinite(p.x + p.y + p.z))) {
      throw InvalidInput(
          fmt::format("{}: a pixel is ({}, {}, {}); radiance is finite and at least 0", path, p.x, p.y, p.z));
    }
  }
  return image;
}

}  // namespace isolux
