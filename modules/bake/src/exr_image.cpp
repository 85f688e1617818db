#include "exr_image.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <iterator>
#include <vector>

namespace isolux {
namespace {

using Window = Imath::Box2i;

std::int64_t width(const Window& window) { return std::int64_t(window.max.x) - window.min.x + 1; }
std::int64_t height(const Window& window) { return std::int64_t(window.max.y) - window.min.y + 1; }
std::int64_t pixels(const Window& window) { return width(window) * height(window); }

std::string text(const Window& window) {
  return fmt::format("{}x{} pixels from {},{}", width(window), height(window), window.min.x, window.min.y);
}

Window both(const Window& a, const Window& b) {
  return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y)},
          {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y)}};
}

void require_sane(const std::string& path, const Window& display, const Window& data) {
  // A header of a few bytes must not ask for a machine's whole memory: neither for windows that nobody paints, nor for
  // a sphere that is black but for a speck.
  constexpr std::int64_t kMost = std::int64_t(1) << 30;
  constexpr std::int64_t kAlways = std::int64_t(1) << 24;
  if (std::max(width(display), height(display)) > kMost || std::max(width(data), height(data)) > kMost ||
      std::max(pixels(display), pixels(data)) > kMost)
    throw InvalidInput(fmt::format("{}: a display window of {} and a data window of {}; at most 2^30 pixels are read",
                                   path, text(display), text(data)));
  const Window shown = both(display, data);
  if (shown.isEmpty())
    throw InvalidInput(fmt::format("{}: the data window, {}, lies outside the display window, {}: nothing is left",
                                   path, text(data), text(display)));
  if (pixels(display) > std::max(kAlways, 256 * pixels(shown)))
    throw InvalidInput(
        fmt::format("{}: a display window of {} that is empty but for {}", path, text(display), text(shown)));
}

/// The pixels of the data window in some of its rows, row by row.
struct Rows {
  int first = 0;
  int last = 0;
  std::size_t width = 0;
  std::vector<Vec3f> pixels{};
};

/// Floats as they are in the file. `names` are its channels of red, green and blue.
void read_channels(Imf::InputFile& file, const char* const names[3], const Window& data, Rows& rows) {
  Imf::FrameBuffer wanted;
  const auto row = std::ptrdiff_t(rows.width);
  Vec3f* const origin = rows.pixels.data() - data.min.x - rows.first * row;
  // Channels that the file lacks are 0.
  for (int c = 0; c < 3; ++c)
    if (wanted.findSlice(names[c]) == nullptr)
      wanted.insert(names[c],
                    Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(origin) + std::ptrdiff_t(sizeof(float)) * c,
                               sizeof(Vec3f), sizeof(Vec3f) * rows.width));
  file.setFrameBuffer(wanted);
  file.readPixels(rows.first, rows.last);
}

/// Luminance and chroma of fewer pixels, through the library's own half floats.
void read_luminance_and_chroma(const std::string& path, const Window& data, Rows& rows) {
  Imf::RgbaInputFile file(path.c_str());
  const auto row = std::ptrdiff_t(rows.width);
  Imf::Array2D<Imf::Rgba> halves(long(rows.last - rows.first) + 1, row);
  file.setFrameBuffer(&halves[0][0] - data.min.x - rows.first * row, 1, rows.width);
  file.readPixels(rows.first, rows.last);
  std::transform(&halves[0][0], &halves[0][0] + rows.pixels.size(), rows.pixels.begin(),
                 [](const Imf::Rgba& p) { return Vec3f(float(p.r), float(p.g), float(p.b)); });
}

void read_rows(const std::string& path, Imf::InputFile& file, const Window& data, Rows& rows) {
  constexpr const char* kColours[3] = {"R", "G", "B"};
  constexpr const char* kLuminance[3] = {"Y", "Y", "Y"};
  const auto has = [&](const char* name) { return file.header().channels().findChannel(name) != nullptr; };
  if (has("RY") || has("BY")) {
    read_luminance_and_chroma(path, data, rows);
  } else if (std::any_of(std::begin(kColours), std::end(kColours), has)) {
    read_channels(file, kColours, data, rows);
  } else if (has("Y")) {
    read_channels(file, kLuminance, data, rows);
    for (Vec3f& p : rows.pixels) p = Vec3f(p.x);
  } else {
    throw InvalidInput(path + ": none of its channels is called R, G, B or Y");
  }
}

ImageEnvironment read_display_window(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imf::Header& header = file.header();
  if (Imf::hasEnvmap(header) && Imf::envmap(header) != Imf::ENVMAP_LATLONG)
    throw InvalidInput(path + ": a cube map; a latitude-longitude picture is wanted");
  const Window& display = header.displayWindow();
  const Window& data = header.dataWindow();
  require_sane(path, display, data);
  const Window shown = both(display, data);
  Rows rows{.first = shown.min.y, .last = shown.max.y, .width = std::size_t(width(data))};
  rows.pixels.resize(rows.width * std::size_t(height(shown)));
  read_rows(path, file, data, rows);
  ImageEnvironment image;
  image.width = int(width(display));
  image.height = int(height(display));
  image.pixels.assign(std::size_t(pixels(display)), Vec3f(0.0f));
  for (int y = shown.min.y; y <= shown.max.y; ++y) {
    const Vec3f* from = rows.pixels.data() + std::size_t(y - rows.first) * rows.width + (shown.min.x - data.min.x);
    Vec3f* to = image.pixels.data() + std::ptrdiff_t(y - display.min.y) * image.width + (shown.min.x - display.min.x);
    std::copy_n(from, width(shown), to);
  }
  return image;
}

}  // namespace

ImageEnvironment read_exr_image(const std::string& path) {
  try {
    return read_display_window(path);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw IoError(fmt::format("{}: cannot read the OpenEXR image: {}", path, error.what()));
  }
}

}  // namespace isolux
