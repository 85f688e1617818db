#pragma once

#include <isolux/sample_sites/site_sampler.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// The centres of a lattice's texels, row by row along x. Immutable; the volume outlives it.
class TexelRows {
 public:
  TexelRows(const Volume& volume, const SiteRequest& request);

  [[nodiscard]] std::size_t count() const { return std::size_t(texels_.y) * std::size_t(texels_.z); }
  /// The centre of texel x of a row, in the volume's index space, as a site has it.
  [[nodiscard]] Vec3f position(std::size_t row, int x) const {
    const std::size_t j = row % std::size_t(texels_.y);
    const std::size_t k = row / std::size_t(texels_.y);
    return Vec3f(to_volume_.world({double(x), double(j), double(k)}));
  }
  /// What a row's texels are found with, kept from row to row.
  struct Scratch {
    std::vector<float> values;         ///< f at the row's y and z, at all x of the volume
    std::vector<std::uint8_t> within;  ///< a byte a texel, and some more that are 0
    std::vector<int> columns;
  };
  /// x of the texels of a row whose isovalue lies within the range, and of some more beside it by a rounding: all of
  /// the row where the texels' axes are not the volume's. They lie in `scratch`. Cost: a nanosecond a texel.
  [[nodiscard]] std::span<const int> columns_within(std::size_t row, const ValueRange& range, Scratch& scratch) const;

 private:
  /// Where a texel's centre lies between two grid points of an axis.
  struct Between {
    int first;
    float fraction;
  };
  [[nodiscard]] Between between(int axis, double at) const;
  void find_values(std::size_t row, std::vector<float>& values) const;
  void find_within(const ValueRange& range, Scratch& scratch) const;

  const Volume& volume_;
  Index3 texels_;
  IndexToWorld to_volume_;
  bool is_aligned_;
  std::vector<int> firsts_;       ///< of each x: Between
  std::vector<float> fractions_;  ///< likewise
  bool is_one_a_cell_ = true;     ///< texel x lies between grid points x and x + 1
  float margin_ = 0.0f;           ///< more than rounding of places and of sums makes of an isovalue
};

}  // namespace isolux
