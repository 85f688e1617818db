#pragma once

#include <isolux/gl_texture/texture3d.h>
#include <isolux/gl_texture/texture_uploader.h>

#include <span>

namespace isolux {

/// A new linear 3D texture of 1 or 3 channels, channel fastest, then x, y, z. OpenGL's state stays as it was.
/// \throw GlError if OpenGL refuses; InvalidInput naming the driver's limit if an axis has more texels than it allows
[[nodiscard]] Texture3D upload_texels(Index3 size, int channels, std::span<const float> values, TexelFormat format,
                                      const TextureMapping& mapping);

/// A new 3D texture of one unsigned integer a texel, to be fetched. \throw as above
[[nodiscard]] Texture3D upload_integers(Index3 size, std::span<const std::uint32_t> values);

}  // namespace isolux
