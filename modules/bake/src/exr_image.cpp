#include "exr_image.h"

#include <ImfArray.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>

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

ImageEnvironment read_display_window(const std::string& path) {
  Imf::RgbaInputFile file(path.c_str());
  if (Imf::hasEnvmap(file.header()) && Imf::envmap(file.header()) != Imf::ENVMAP_LATLONG)
    throw InvalidInput(path + ": a cube map; a latitude-longitude picture is wanted");
  const Window display = file.displayWindow();
  const Window data = file.dataWindow();
  require_sane(path, display, data);
  const Window shown = both(display, data);
  const auto stride = std::ptrdiff_t(width(data));
  Imf::Array2D<Imf::Rgba> rows(long(height(shown)), stride);
  file.setFrameBuffer(&rows[0][0] - data.min.x - std::ptrdiff_t(shown.min.y) * stride, 1, std::size_t(stride));
  file.readPixels(shown.min.y, shown.max.y);
  ImageEnvironment image;
  image.width = int(width(display));
  image.height = int(height(display));
  image.pixels.assign(std::size_t(pixels(display)), Vec3f(0.0f));
  for (int y = shown.min.y; y <= shown.max.y; ++y) {
    const Imf::Rgba* from = rows[y - shown.min.y] + (shown.min.x - data.min.x);
    Vec3f* to = image.pixels.data() + std::ptrdiff_t(y - display.min.y) * image.width + (shown.min.x - display.min.x);
    std::transform(from, from + width(shown), to,
                   [](const Imf::Rgba& p) { return Vec3f(float(p.r), float(p.g), float(p.b)); });
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
