#include "box_entry.h"

#include <algorithm>
#include <limits>

namespace isolux {

std::optional<BoxEntry> enter_box(const Vec3& origin, const Vec3& direction, const Index3& size) {
  BoxEntry entry{.t = 0.0, .axis = -1};
  double leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const double high = size[a] - 1;
    if (direction[a] == 0.0) {
      if (!(origin[a] >= 0.0 && origin[a] <= high)) return std::nullopt;
      continue;
    }
    const double near = ((direction[a] > 0.0 ? 0.0 : high) - origin[a]) / direction[a];
    const double far = ((direction[a] > 0.0 ? high : 0.0) - origin[a]) / direction[a];
    if (near > entry.t) entry = {.t = near, .axis = a};
    leave = std::min(leave, far);
  }
  if (!(entry.t <= leave)) return std::nullopt;
  return entry;
}

}  // namespace isolux
