#pragma once

#include <isolux/core/volume.h>

#include <array>
#include <vector>

namespace isolux {

/// Least and greatest corner value of every brick of cells, on three levels: bricks of 2^3, 4^3 and 16^3 cells. A brick
/// whose greatest value lies below an isovalue holds no point of its inner side, for any isovalue at all, so that a ray
/// on the outer side crosses it unseen (Parker et al., "Interactive ray tracing for isosurface rendering", 1998).
/// Memory: 1.1 bytes a voxel. Cost: one pass over the volume.
class Macrocells {
 public:
  struct Level {
    int shift = 0;           ///< a brick is 2^shift cells wide
    Index3 size{0};          ///< bricks an axis
    std::vector<float> low;  ///< x fastest
    std::vector<float> high;

    [[nodiscard]] std::size_t offset(const int* cell) const {
      return (std::size_t(cell[2] >> shift) * std::size_t(size.y) + std::size_t(cell[1] >> shift)) *
                 std::size_t(size.x) +
             std::size_t(cell[0] >> shift);
    }
  };
  static constexpr std::array<int, 3> kShifts{1, 2, 4};

  explicit Macrocells(const Volume& volume);

  /// Finest first.
  [[nodiscard]] const std::array<Level, kShifts.size()>& levels() const { return levels_; }

 private:
  std::array<Level, kShifts.size()> levels_;
};

}  // namespace isolux
