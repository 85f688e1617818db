#pragma once

#include <isolux/core/light_bricks.h>
#include <isolux/gl_texture/texture3d.h>
#include <isolux/gl_texture/texture_uploader.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace isolux {

/// LightBricks on the graphics card: a shader fetches a page, which says where in the atlas its brick is, and has the
/// hardware filter within that. light_reader_glsl() in isolux/resample does so.
struct BrickTextures {
  Texture3D pages;   ///< a texel of 10, 10, 10 and 2 bits a page, see page_entry(); not filtered
  Texture3D values;  ///< the atlas: bricks of kTexels^3 texels side by side
  std::optional<Texture3D> slopes;
  std::array<std::optional<Texture3D>, 3> normal_slopes;

  [[nodiscard]] std::size_t bytes() const {
    std::size_t all = pages.bytes() + values.bytes();
    for (const std::optional<Texture3D>* atlas : {&slopes, &normal_slopes[0], &normal_slopes[1], &normal_slopes[2]})
      if (*atlas) all += (*atlas)->bytes();
    return all;
  }
};

/// Bricks an axis of an atlas for `count` of them: nearly a cube, the last layer not always full.
[[nodiscard]] Index3 atlas_size(std::size_t count);

/// What the page table says of a brick at this place of the atlas, in bricks below 1024: x, y and z in 10 bits each,
/// which a shader reads as red, green and blue of 1/1023, below an alpha of 1. A page without a brick has an alpha of
/// 0.
[[nodiscard]] constexpr std::uint32_t page_entry(const Index3& brick) {
  return 3u << 30 | std::uint32_t(brick.x) | std::uint32_t(brick.y) << 10 | std::uint32_t(brick.z) << 20;
}

/// Needs a current OpenGL 3.3 core context (or newer), whose state it leaves as it was. \throw GlError if OpenGL
/// refuses; InvalidInput if the bricks are more than the driver's largest texture holds
[[nodiscard]] BrickTextures upload_bricks(const LightBricks& bricks, TexelFormat format);

}  // namespace isolux
