#pragma once

#include <isolux/core/lattice.h>

namespace isolux {

/// How finely the float world coordinates of a mesh tell places in this lattice's box apart: in steps of the lattice,
/// along each index axis. A coordinate has the resolution of a float at the box's farthest one, and what that is along
/// an index axis the frame says: of an axis-aligned one, the same over the spacing. Rounding moves a vertex by less
/// than 8 times as much. Cost: constant.
[[nodiscard]] Vec3 vertex_resolution(const Lattice& lattice);

}  // namespace isolux
