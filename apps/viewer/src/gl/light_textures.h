#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/volume.h>
#include <isolux/gl_texture/texture3d.h>
#include <isolux/resample/light_reader.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "gl/objects.h"

namespace isolux::viewer {

/// Values that the driver takes on an axis of a 3D texture. Needs a current context.
[[nodiscard]] int largest_texture();

/// What a light takes on the graphics card, bytes.
struct LightMemory {
  std::size_t light = 0;   ///< texels, and page table where there is one
  std::size_t dense = 0;   ///< the same texels without bricks; equal to `light` where there are none
  std::size_t volume = 0;  ///< of the volume's values, for what is computed at vertices
};

/// A light as light_reader_glsl() reads it: its textures and uniforms. That of a known range of isovalues is kept in
/// bricks where that is less.
class LightTextures {
 public:
  /// \throw GlError, InvalidInput as TextureUploader::upload, upload_bricks() and LightReader
  LightTextures(const Volume& volume, const IlluminationGrid& light);

  /// What its shader needs to know.
  [[nodiscard]] LightShader kind() const;
  /// Sets the uniforms of light_at_vertices_glsl() of the program in use and binds the volume and textures. \pre
  /// kind().at_vertices()
  void bind_at_vertices(const ShaderProgram& program) const;
  /// Sets the uniforms of the program in use and binds the textures.
  void bind(const ShaderProgram& program) const;

  [[nodiscard]] const LightMemory& memory() const { return memory_; }

 private:
  void upload(const LightReader& reader, const IlluminationGrid& light);
  /// How a place of the box is found in the textures.
  void bind_places(const ShaderProgram& program) const;

  Lattice volume_;
  TextureMapping mapping_;
  Vec3f texels_;
  Texture3D offsets_;
  std::optional<Texture3D> slopes_;
  std::array<std::optional<Texture3D>, 3> normals_;
  std::optional<Texture3D> pages_;   ///< with them those above are atlases of bricks
  std::optional<Texture3D> values_;  ///< of the volume, for what is computed at vertices
  std::vector<NearFieldTerm> terms_;
  float reference_isovalue_ = 0.0f;
  float ceiling_ = 0.0f;
  LightMemory memory_;
};

}  // namespace isolux::viewer
