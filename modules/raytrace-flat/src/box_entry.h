#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/vec.h>

#include <optional>

namespace isolux {

/// Where a line enters the box of a volume's grid points.
struct BoxEntry {
  double t;  ///< in lengths of the direction; 0 if it starts inside
  int axis;  ///< of the face that it enters through, -1 if it starts inside
};

/// For a ray in index space; nothing if it misses the box.
[[nodiscard]] std::optional<BoxEntry> enter_box(const Vec3& origin, const Vec3& direction, const Index3& size);

}  // namespace isolux
