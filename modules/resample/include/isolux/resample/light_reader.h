#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/run.h>
#include <isolux/core/volume.h>
#include <isolux/resample/light_bricks.h>

#include <memory>
#include <string>
#include <vector>

namespace isolux {

/// How a reader holds the texels.
enum class TexelStorage {
  kDense,   ///< all of them: offsets() and slopes() are the whole grid's
  kBricks,  ///< those of the light's own range of isovalues in bricks where that is smaller: bricks() are what there is
  /// None but those of TexelLight::kOwn: every reading takes its eight out of the grid, which must outlive the reader.
  /// For thousands of readings, not for millions; there are no offsets() nor slopes().
  kLent
};

/// Reads an illumination grid the best way known, with the volume at hand:
///
///     e = clamp(V + S (h - h0) + B . n + sum over near-field terms of weight (openness - mean), 0, ceiling)
///
/// V, S and B interpolate the textures below trilinearly, h is the isovalue of the point and n its level set's normal
/// towards lower values; docs/resampling.md says why. A plain grid is read trilinearly. Immutable, callable from many
/// threads; the volume must outlive it.
class LightReader {
 public:
  /// One pass over the grid, unless it is lent; where it has near-field terms and TexelLight::kOwn, some tenths of a
  /// microsecond a texel on all threads of `run`. \pre require_usable(volume). \throw InvalidInput if the grid is not
  /// complete, its detail does not match or they leave the range of floats together (of what is lent, where it is
  /// read); Cancelled
  LightReader(const Volume& volume, const IlluminationGrid& light, TexelStorage storage = TexelStorage::kDense,
              const Run& run = {});
  LightReader(Volume&& volume, const IlluminationGrid& light, TexelStorage storage = TexelStorage::kDense,
              const Run& run = {}) = delete;  ///< it would not outlive this
  ~LightReader();
  LightReader(LightReader&&) noexcept;
  LightReader& operator=(LightReader&&) noexcept;

  /// e at a point of the volume's index space on the level set of its own value; grey grids give it three times. Points
  /// outside the box are read at its nearest point.
  [[nodiscard]] Vec3f at_index(const Vec3& index) const;
  /// The same with the isovalue known, as on the vertices of a mesh.
  [[nodiscard]] Vec3f at_index(const Vec3& index, double isovalue) const;
  /// e at a world position.
  [[nodiscard]] Vec3f at_world(const Vec3& world) const;

  /// V of the formula, in the layout of `light.values`: what a shader samples with hardware filtering. Without values
  /// where there are bricks().
  [[nodiscard]] const IlluminationGrid& offsets() const;
  /// S of the formula in the same layout; empty without slopes, or where there are bricks().
  [[nodiscard]] const std::vector<float>& slopes() const;
  /// Component x, y or z of B of the formula, likewise.
  [[nodiscard]] const std::vector<float>& normal_slopes(std::size_t axis) const;
  /// V, S and B in bricks; null unless asked for and smaller. Level sets outside the light's range are then dark where
  /// no brick is.
  [[nodiscard]] const LightBricks* bricks() const;
  /// h0 of the formula.
  [[nodiscard]] float reference_isovalue() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// What of the formula a light needs.
struct LightShader {
  bool slopes = false;
  bool normals = false;
  bool bricks = false;
  int near_field_terms = 0;

  /// Whether anything of the formula is computed at vertices, by light_at_vertices_glsl().
  [[nodiscard]] bool at_vertices() const { return normals || near_field_terms > 0; }

  bool operator==(const LightShader&) const = default;
};

/// The formula for one kind of light as a shader of its own in GLSL 3.30, to be linked to one that declares and calls
/// `vec3 read_light(vec3 place, float isovalue, vec3 at_vertices)`: place in the volume's box from 0 to 1, and what
/// light_at_vertices_glsl() gives there. It needs the uniforms that its first lines declare. Kinds are constants of the
/// shader: one that branched on uniforms would pay for all of them.
[[nodiscard]] std::string light_reader_glsl(const LightShader& kind);

/// `vec3 light_at_vertices(vec3 place, float isovalue)`, the sum over near-field terms and B . n, as a shader likewise,
/// for any stage: six fetches of the volume, one a term, and three of the light. It may be computed at a surface's
/// vertices and interpolated between them (docs/measured/resampling.md has what that does to the error).
/// \pre kind.at_vertices()
[[nodiscard]] std::string light_at_vertices_glsl(const LightShader& kind);

}  // namespace isolux
