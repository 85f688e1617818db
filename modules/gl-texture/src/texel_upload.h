#pragma once

#include <isolux/gl_texture/texture3d.h>
#include <isolux/gl_texture/texture_uploader.h>

#include <span>

namespace isolux {

/// A new linear 3D texture of 1 or 3 channels, channel fastest, then x, y, z. OpenGL's state stays as it was.
/// \throw GlError if OpenGL refuses; InvalidInput naming the driver's limit if an axis has more texels than it allows
[[nodiscard]] Texture3D upload_texels(Index3 size, int channels, std::span<const float> values, TexelFormat format,
                                      const TextureMapping& mapping);

/// A new unfiltered 3D texture of 10, 10, 10 and 2 bits a texel, red in the lowest, that a shader reads as 0 to 1.
/// \throw as above
[[nodiscard]] Texture3D upload_packed(Index3 size, std::span<const std::uint32_t> values);

}  // namespace isolux
