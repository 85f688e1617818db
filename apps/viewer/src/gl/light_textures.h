#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/volume.h>
#include <isolux/gl_texture/texture3d.h>

#include <optional>
#include <vector>

#include "gl/objects.h"

namespace isolux::viewer {

/// A light as light_reader_glsl() reads it: its textures and uniforms.
class LightTextures {
 public:
  /// \throw GlError, InvalidInput as TextureUploader::upload and LightReader; InvalidInput for more near-field terms
  /// than the shader takes
  LightTextures(const Volume& volume, const IlluminationGrid& light);

  /// Sets the uniforms of the program in use and binds the textures to units 0 to 2.
  void bind(const ShaderProgram& program) const;

 private:
  Lattice volume_;
  Texture3D offsets_;
  std::optional<Texture3D> slopes_;
  std::optional<Texture3D> values_;  ///< of the volume, for the near field
  std::vector<NearFieldTerm> terms_;
  float reference_isovalue_ = 0.0f;
  float ceiling_ = 0.0f;
};

}  // namespace isolux::viewer
