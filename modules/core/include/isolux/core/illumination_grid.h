#pragma once

#include <isolux/core/lattice.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// A regular grid of e = irradiance/pi over a volume's box; what lights any isosurface later.
struct IlluminationGrid {
  Lattice lattice;            ///< texel centres in world space
  int channels = 1;           ///< 1 (grey) or 3 (RGB)
  std::vector<float> values;  ///< channel fastest, then x, y, z

  IlluminationGrid() = default;
  IlluminationGrid(const Lattice& texels, int channel_count)
      : lattice(texels), channels(channel_count), values(texels.count() * std::size_t(channel_count), 0.0f) {}

  /// e at a point in the texels' own index space (texel centres at integers), trilinear, clamped to the edge texels as
  /// GL_CLAMP_TO_EDGE does. Grey grids give the same value three times.
  [[nodiscard]] Vec3f at_index(const Vec3& texel_index) const;
  /// e at a world position.
  [[nodiscard]] Vec3f at_world(const Vec3& world) const;
};

}  // namespace isolux
