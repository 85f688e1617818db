#pragma once

#include <isolux/core/volume.h>

#include <functional>

namespace isolux {

/// A volume of `size` grid points, index space = world space, with values f(i, j, k).
inline Volume index_volume(Index3 size, const std::function<double(const Vec3&)>& f) {
  Volume volume;
  volume.name = "test";
  volume.values = Grid<float>(Lattice{.size = size, .frame = {}});
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) volume.values(i, j, k) = float(f(Vec3(i, j, k)));
    }
  }
  return volume;
}

}  // namespace isolux
