#pragma once

#include <isolux/render/image.h>

namespace isolux::viewer {

/// The current read framebuffer's colours, which are sRGB codes, as a picture in linear radiance: what write_png()
/// turns back into the same codes.
[[nodiscard]] Image read_pixels(int width, int height);

}  // namespace isolux::viewer
