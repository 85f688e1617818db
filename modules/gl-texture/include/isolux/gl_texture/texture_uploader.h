#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/registry.h>
#include <isolux/gl_texture/texture3d.h>

#include <cstdint>

namespace isolux {

/// How a channel of a texel is stored.
enum class TexelFormat : std::uint8_t {
  kUnorm8,   ///< 8 bits, 255 steps from 0 to the brightest texel
  kFloat16,  ///< 11 significant bits, down to 2^-29 of the brightest texel
  kFloat32
};

/// The gl-texture stage. Needs a current OpenGL 3.3 core context (or newer), whose state it leaves as it was. Backends
/// are immutable.
class TextureUploader {
 public:
  static constexpr std::string_view kStage = "uploader";
  virtual ~TextureUploader() = default;

  /// The light as a texture over the box of `volume`. \throw GlError if GL refuses; InvalidInput naming the driver's
  /// limit if an axis has more texels than it allows, or if the light is not over an axis-parallel box of the volume.
  [[nodiscard]] virtual Texture3D upload(const IlluminationGrid& light, const Lattice& volume) const = 0;
};

/// whole.
[[nodiscard]] Registry<TextureUploader> uploaders();

}  // namespace isolux
