#pragma once

#include <isolux/core/lattice.h>

namespace isolux {

/// How finely the float world coordinates of a mesh tell places in this lattice's box apart: in steps of the lattice,
/// along each index axis. A coordinate has the resolution of a float at the box's farthest one, and what that is along
/// an index axis the frame says: of an axis-aligned one, the same over the spacing. Rounding moves a vertex by less
/// than 8 times as much. Cost: constant.
[[nodiscard]] Vec3 vertex_resolution(const Lattice& lattice);

/// How far vertices keep from grid points, so that no triangle is empty, as part of an edge along each index axis:
/// 2^-10, or 16 times the vertex_resolution() along it where that is coarser, at most 1/4.
[[nodiscard]] Vec3f vertex_margin(const Lattice& lattice);

/// Places that float coordinates tell apart along a voxel, on the axis where they tell fewest.
[[nodiscard]] double places_a_voxel(const Lattice& lattice);
/// With fewer the margin would have to be more than a quarter of an edge: triangles may be empty, and no cap can tell
/// which side of the box a vertex lies on.
inline constexpr double kPlacesEnough = 64.0;

}  // namespace isolux
