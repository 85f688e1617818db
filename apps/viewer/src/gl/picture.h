#pragma once

#include <isolux/render/image.h>

#include <functional>
#include <glm/vec2.hpp>

namespace isolux::viewer {

/// A picture of any size that OpenGL draws, whatever the window's: into a framebuffer of its own with four samples a
/// pixel, tile by tile. `draw` is called once a tile, with the pixel of the picture (from its lower left) that is the
/// framebuffer's first. What was bound before is bound again. \throw GlError if the driver has no such viewport or no
/// memory; and whatever `draw` throws
[[nodiscard]] Image draw_picture(int width, int height, const std::function<void(const glm::ivec2& first)>& draw);

}  // namespace isolux::viewer
