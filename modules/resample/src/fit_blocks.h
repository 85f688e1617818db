#pragma once

#include <isolux/core/run.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "fit_vector.h"

namespace isolux {

/// The preconditioner of a fit: the inverse of what its matrix says of each texel's numbers among themselves, and of
/// the terms'. A texel's value, slope and normals are seen through the same few samples and are far from independent,
/// and so are openness a step and two out.
class FitBlocks {
 public:
  /// All zero, to be added to.
  FitBlocks(std::size_t texels, std::size_t numbers);

  /// Element (j, k) of every texel's block, 0 <= j <= k < numbers.
  [[nodiscard]] float* plane(std::size_t j, std::size_t k) { return &planes_[pair(j, k) * texels_]; }
  /// Row by row.
  using TermBlock = std::array<std::array<double, kNearFieldSteps.size()>, kNearFieldSteps.size()>;
  [[nodiscard]] TermBlock& terms() { return terms_; }

  /// Turns blocks, symmetric and positive but for rounding, into their inverses.
  void invert(const Run& run);
  /// y = the inverses times x.
  void apply(const FitVector& x, FitVector& y, const Run& run) const;

 private:
  template <std::size_t kNumbers>
  void invert_texels(const Run& run);
  [[nodiscard]] std::size_t pair(std::size_t j, std::size_t k) const { return j * numbers_ - j * (j + 1) / 2 + k; }

  std::size_t texels_;
  std::size_t numbers_;
  std::vector<float> planes_;
  TermBlock terms_{};
};

}  // namespace isolux
