#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/registry.h>
#include <isolux/gl_texture/texture3d.h>

namespace isolux {

/// How texels are stored.
enum class TexelFormat { kUnorm8, kFloat16, kFloat32 };

/// The gl-texture stage. Needs a current OpenGL 3.3 core context (or newer). Backends are immutable.
class TextureUploader {
 public:
  static constexpr std::string_view kStage = "uploader";
  virtual ~TextureUploader() = default;

  /// The light as a texture over the box of `volume`. \throw GlError if GL refuses; InvalidInput naming the driver's
  /// limit if an axis has more texels than it allows.
  [[nodiscard]] virtual Texture3D upload(const IlluminationGrid& light, const Lattice& volume) const = 0;
};

[[nodiscard]] Registry<TextureUploader> uploaders();

}  // namespace isolux
