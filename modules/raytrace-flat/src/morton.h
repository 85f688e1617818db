#pragma once

#include <cstdint>

namespace isolux {

/// The place of a point of the unit square, in fractions of 2^32, along Morton's curve (1966): the bits of both
/// numbers, highest first, u before v. Neighbours on the curve are mostly neighbours in the square, and every aligned
/// 4^m places are a square.
[[nodiscard]] constexpr std::uint64_t morton_place(std::uint32_t u, std::uint32_t v) {
  std::uint64_t place = 0;
  for (int bit = 31; bit >= 0; --bit) place = place << 2 | std::uint64_t(u >> bit & 1) << 1 | (v >> bit & 1);
  return place;
}

}  // namespace isolux
