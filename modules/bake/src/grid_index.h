#pragma once

#include <isolux/core/vec.h>

#include <cstddef>

namespace isolux {

/// The place of a grid of `size`, x fastest, that has this number.
inline Index3 index_of(const Index3& size, std::size_t number) {
  const auto nx = std::size_t(size.x);
  const auto ny = std::size_t(size.y);
  return {int(number % nx), int(number / nx % ny), int(number / nx / ny)};
}

inline bool inside(const Index3& i, const Index3& size) {
  return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < size.x && i.y < size.y && i.z < size.z;
}

/// From the lowest corner of a cube to corner 0 to 7, x fastest.
inline Index3 corner_step(int corner) { return {corner & 1, corner >> 1 & 1, corner >> 2 & 1}; }

}  // namespace isolux
