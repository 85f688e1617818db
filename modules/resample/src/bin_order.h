#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "metric.h"

namespace isolux {

/// Points sorted into cubic bins over the box from 0 to a far corner; those outside go to the nearest bin.
struct BinOrder {
  BinOrder(std::span<const Point> points, const Point& far_corner, double points_a_bin);

  float side = 1.0f;  ///< of a bin
  std::array<int, 3> size{1, 1, 1};
  std::vector<std::uint32_t> starts;  ///< of each bin's points, and the end; a row of bins along x is contiguous
  std::vector<std::uint32_t> points;  ///< as they were given, bin by bin

  [[nodiscard]] std::array<int, 3> bin(const Point& p) const;
  [[nodiscard]] std::size_t offset(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) + std::size_t(i);
  }
};

}  // namespace isolux
