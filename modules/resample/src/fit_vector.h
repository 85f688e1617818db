#pragma once

#include <isolux/core/run.h>

#include <array>
#include <cstddef>
#include <vector>

#include "fit_cell.h"

namespace isolux {

/// What a fit solves for, or any vector of that shape: FitTerms::count() planes of a number for each texel used, and a
/// few weights for all.
struct FitVector {
  std::vector<float> numbers;                          ///< slopes per unit of the texels' breadths
  std::array<double, kNearFieldSteps.size()> terms{};  ///< zero without near field
};

/// y += a x
void add_scaled(FitVector& y, double a, const FitVector& x, const Run& run);
/// y = x + a y
void add_to_scaled(FitVector& y, double a, const FitVector& x, const Run& run);
/// The scalar product, summed in a fixed order.
[[nodiscard]] double product(const FitVector& x, const FitVector& y, const Run& run);

}  // namespace isolux
