#pragma once

#include <isolux/core/lattice.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isolux::bench {

/// Calls visit(cell, t0, t1) for the cells that the ray crosses from t = 0 on, near ones first, until visit returns
/// false, the ray leaves the box or t reaches `end` (Amanatides & Woo, "A fast voxel traversal algorithm", 1987). Index
/// space; nothing is skipped, which is what it is for: to know what skipping saves.
template <class Visit>
void walk_cells(const Lattice& lattice, const Vec3& origin, const Vec3& direction, double end, Visit&& visit) {
  Index3 cell{0};
  Vec3 next(std::numeric_limits<double>::infinity());
  Vec3 step(std::numeric_limits<double>::infinity());
  for (int a = 0; a < 3; ++a) {
    const bool backward = direction[a] < 0.0;
    // A start on a face belongs to the cell that the ray goes into.
    cell[a] = backward ? int(std::ceil(origin[a])) - 1 : int(origin[a]);
    if (direction[a] == 0.0) {
      cell[a] = std::min(cell[a], lattice.size[a] - 2);
    } else {
      next[a] = (double(backward ? cell[a] : cell[a] + 1) - origin[a]) / direction[a];
      step[a] = 1.0 / std::fabs(direction[a]);
    }
    if (cell[a] < 0 || cell[a] > lattice.size[a] - 2) return;
  }
  for (double t = 0.0; t < end;) {
    const int axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
    const double leave = std::max(t, next[axis]);
    if (!visit(cell, t, leave)) return;
    t = leave;
    next[axis] += step[axis];
    cell[axis] += direction[axis] < 0.0 ? -1 : 1;
    if (cell[axis] < 0 || cell[axis] > lattice.size[axis] - 2) return;
  }
}

}  // namespace isolux::bench
