#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/volume.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// The centres of a lattice's texels, row by row along x. Immutable; the volume outlives it.
class TexelRows {
 public:
  TexelRows(const Volume& volume, const Lattice& texels);

  [[nodiscard]] std::size_t count() const { return std::size_t(texels_.y) * std::size_t(texels_.z); }
  /// The centre of texel x of a row, in the volume's index space, as a site has it.
  [[nodiscard]] Vec3f position(std::size_t row, int x) const {
    const std::size_t j = row % std::size_t(texels_.y);
    const std::size_t k = row / std::size_t(texels_.y);
    return Vec3f(to_volume_.world({double(x), double(j), double(k)}));
  }
  /// x of the texels of a row whose isovalue lies within the range, and of some more beside it by a rounding: all of
  /// the row where the texels' axes are not the volume's. Cost: some nanoseconds a texel.
  [[nodiscard]] std::vector<int> columns_within(std::size_t row, const ValueRange& range) const;

 private:
  /// Where a texel's centre lies between two grid points of an axis.
  struct Between {
    int first;
    float fraction;
  };
  [[nodiscard]] Between between(int axis, double at) const;
  /// f at the row's y and z, at all x of the volume.
  [[nodiscard]] std::vector<float> values_along(std::size_t row) const;

  const Volume& volume_;
  Index3 texels_;
  IndexToWorld to_volume_;
  bool is_aligned_ = true;
  std::vector<Between> columns_;  ///< of each x
  float margin_ = 0.0f;           ///< more than rounding of places and of sums makes of an isovalue
};

}  // namespace isolux
