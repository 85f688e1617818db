#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isolux {

/// Steps of a fit's near-field terms, in mean grid spacings; docs/measured/resampling.md has what fewer and others are
/// worth.
inline constexpr std::array<double, 4> kNearFieldSteps = {0.5, 1.0, 2.0, 4.0};

/// What a fit says of a texel beside its value.
struct FitTerms {
  bool slopes = false;   ///< how its light changes with the isovalue
  bool normals = false;  ///< and with the three components of the normal

  static constexpr std::size_t kMost = 5;
  /// Numbers a texel: the value, the slope, x, y and z, as far as they are there.
  [[nodiscard]] std::size_t count() const { return first_normal() + (normals ? 3 : 0); }
  [[nodiscard]] std::size_t first_normal() const { return slopes ? 2 : 1; }
};

/// A sample in its cell of texels. Products read nothing else of it but its weight. Light there is the sum over a
/// texel's numbers of feature * (sum over the cell's corners of trilinear weight * number), and the terms' openness.
struct FitRow {
  std::array<float, 3> place;  ///< 0 to 1
  /// What the numbers after the value, whose is 1, are multiplied with, in the order of FitTerms: the isovalue less
  /// that of the cell's first texel, and the normal.
  std::array<float, FitTerms::kMost - 1> feature;
  std::array<float, kNearFieldSteps.size()> openness;  ///< less the mean
};

}  // namespace isolux
