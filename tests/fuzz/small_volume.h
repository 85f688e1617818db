// Small volumes of any values, and isovalues that matter to them.
#pragma once

#include <isolux/core/volume.h>

#include <cmath>
#include <numeric>

#include "fuzz.h"

namespace isolux::fuzz {

/// Of 2 to `most` grid points an axis. A first byte says what the others are: bits of floats, the same without what is
/// not finite, or whole numbers of 8 or 16 bits, of which many are equal.
inline Volume small_volume(Bytes& bytes, int most) {
  const int kind = bytes.below(4);
  const auto axis = [&] { return 2 + bytes.below(most - 1); };
  const int x = axis();
  const int y = axis();
  Volume volume;
  volume.name = "fuzz";
  volume.values = Grid<float>(Lattice{.size = {x, y, axis()}, .frame = {}});
  for (float& value : volume.values.values()) {
    switch (kind) {
      case 0:
      case 1:
        value = bytes.next<float>();
        if (kind == 1 && !std::isfinite(value)) value = 0.0f;
        break;
      case 2:
        value = float(bytes.next<std::int8_t>());
        break;
      default:
        value = float(bytes.next<std::int16_t>());
        break;
    }
  }
  return volume;
}

/// Any float, a voxel's value, or one between two of them.
inline float some_isovalue(Bytes& bytes, const Volume& volume) {
  const auto values = volume.values.values();
  const auto voxel = [&] { return values[bytes.next<std::uint16_t>() % values.size()]; };
  switch (bytes.below(3)) {
    case 0:
      return bytes.next<float>();
    case 1:
      return voxel();
    default: {
      const float one = voxel();
      return std::midpoint(one, voxel());
    }
  }
}

}  // namespace isolux::fuzz
