#pragma once

#include <isolux/core/volume.h>

#include <vector>

namespace isolux {

/// Least and greatest corner value of every brick of cells, on two levels: bricks of 4^3 and of 16^3 cells. A brick
/// whose greatest value lies below an isovalue holds no point of its inner side, for any isovalue at all, so that a ray
/// on the outer side crosses it unseen (Parker et al., "Interactive ray tracing for isosurface rendering", 1998).
/// Memory: 1/8 byte a voxel. Cost: one pass over the volume.
class Macrocells {
 public:
  static constexpr int kFineShift = 2;
  static constexpr int kCoarseShift = 4;

  struct Level {
    int shift = 0;
    Index3 size{0};          ///< bricks an axis
    std::vector<float> low;  ///< x fastest
    std::vector<float> high;

    [[nodiscard]] std::size_t offset(const int* cell) const {
      return (std::size_t(cell[2] >> shift) * std::size_t(size.y) + std::size_t(cell[1] >> shift)) *
                 std::size_t(size.x) +
             std::size_t(cell[0] >> shift);
    }
  };

  explicit Macrocells(const Volume& volume);

  [[nodiscard]] const Level& fine() const { return fine_; }
  [[nodiscard]] const Level& coarse() const { return coarse_; }

 private:
  Level fine_;
  Level coarse_;
};

}  // namespace isolux
