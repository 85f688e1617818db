#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/volume.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace isolux {

/// One term of what the volume itself says of the light at a point: how open the level set is a step in front of it.
struct NearFieldTerm {
  float step = 0.0f;   ///< towards lower values, in mean grid spacings of the volume; negative: towards higher ones
  float mean = 0.0f;   ///< the openness that adds nothing
  Vec3f weight{0.0f};  ///< change of e per unit of openness, by channel
};

/// What the values are where there are near-field terms.
enum class TexelLight : std::uint8_t {
  kReduced,  ///< less the terms' sum at the texels
  kOwn       ///< the texels' own light, so that it is right without the terms too
};

/// What lets light be read more finely than the texels are, with the volume at hand (isolux/resample/light_reader.h).
/// Empty in a plain grid; a reader that does not know it reads the values alone.
struct LightDetail {
  std::vector<float> slopes;  ///< change of e per unit of the isovalue about each texel, in the order of the values
  /// Likewise per unit of x, y and z of the level set's unit normal towards lower values, world space; all or none.
  std::array<std::vector<float>, 3> normal_slopes;
  std::vector<NearFieldTerm> near_field;
  TexelLight texel_light = TexelLight::kReduced;
  float ceiling = std::numeric_limits<float>::infinity();  ///< no light is above it (nor below 0)
  std::optional<ValueRange> isovalues{};  ///< the level sets that were lit; texels that none of them touches may be 0

  [[nodiscard]] bool empty() const { return slopes.empty() && normal_slopes[0].empty() && near_field.empty(); }
  /// Whether the level set of an isovalue was lit.
  [[nodiscard]] bool covers(double isovalue) const {
    return !isovalues || (isovalue >= double(isovalues->low) && isovalue <= double(isovalues->high));
  }
  /// Numbers a value of the grid is stored as.
  [[nodiscard]] int numbers() const { return 1 + (slopes.empty() ? 0 : 1) + (normal_slopes[0].empty() ? 0 : 3); }
};

/// A regular grid of e = irradiance/pi over a volume's box; what lights any isosurface later.
struct IlluminationGrid {
  Lattice lattice;            ///< texel centres in world space
  int channels = 1;           ///< 1 (grey) or 3 (RGB)
  std::vector<float> values;  ///< channel fastest, then x, y, z
  LightDetail detail;

  IlluminationGrid() = default;
  /// All black. \throw InvalidInput for sizes below 0, more texels than memory can be asked for, and channels below 1
  IlluminationGrid(const Lattice& texels, int channel_count);

  /// e at a point in the texels' own index space (texel centres at integers), trilinear, clamped to the edge texels as
  /// GL_CLAMP_TO_EDGE does, the detail left aside. Grey grids give the same value three times. \pre require_complete().
  [[nodiscard]] Vec3f at_index(const Vec3& texel_index) const;
  /// e at a world position.
  [[nodiscard]] Vec3f at_world(const Vec3& world) const;
};

/// \throw InvalidInput unless it has texels, 1 or 3 channels, a value for each, axes that span a volume, and of each
/// kind of slopes none or as many as values, those along the normal on all axes or on none
void require_complete(const IlluminationGrid& light);

}  // namespace isolux
