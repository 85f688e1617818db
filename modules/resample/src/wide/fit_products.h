#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fit_cell.h"

namespace isolux::wide {

template <class Real>
using FitTermSums = std::array<Real, kNearFieldSteps.size()>;

/// A row of cells along x, their texels and their samples.
struct FitCells {
  std::size_t count = 0;
  const std::uint32_t* starts = nullptr;         ///< numbers of each cell's first row, and the end
  std::array<const std::uint32_t*, 4> texels{};  ///< each cell's texels at lower x
  bool has_pairs = true;         ///< the texels at higher x are the next ones; otherwise there is one an axis, for both
  const FitRow* rows = nullptr;  ///< all
  const float* weights = nullptr;    ///< of all rows
  std::size_t texel_count = 0;       ///< in each plane
  const float* isovalues = nullptr;  ///< of all texels; null without slopes
};

/// Adds W A x, by A's transpose, to planes of sums and to `term_sums`. x is planes of texels' moved numbers
/// (FitTexels::moved()) and the terms.
using FitProduct = void (*)(const FitCells& cells, const float* numbers, const FitTermSums<float>& terms, float* sums,
                            FitTermSums<double>& term_sums);

/// What light the rows have, and between what it is read.
struct FitLight {
  const float* light = nullptr;  ///< of the first sample; those of others follow `stride` apart
  std::size_t stride = 1;
  const std::uint32_t* samples = nullptr;  ///< of each row
  float low = 0.0f;
  float high = 0.0f;
  float clamped_part = 0.0f;  ///< of its weight that a row keeps where its reading is clamped
};

/// Adds W (light - reading), by A's transpose, likewise, and sets the rows' weights in the linear problem. In double
/// precision: here small rests are told from the light.
using FitLeft = void (*)(const FitCells& cells, const FitLight& light, const float* numbers,
                         const FitTermSums<double>& terms, float* sums, FitTermSums<double>& term_sums, float* follows);

/// Planes from which texels' numbers count, and in which unit; null for none. Values count from 0 in units of 1.
struct FitCentres {
  const float* inverse_breadths = nullptr;
  std::array<const float*, 3> normals{};
};

/// Adds the blocks of A^T W A: planes of the upper triangle of each texel's, row by row (00 01 02 .. 11 12 ..), and the
/// terms'.
using FitMoments = void (*)(const FitCells& cells, const FitCentres& centres, float* sums,
                            std::array<FitTermSums<double>, kNearFieldSteps.size()>& term_sums);

/// The kernels for texels of so many numbers on this machine.
struct FitKernels {
  FitProduct product = nullptr;
  FitLeft left = nullptr;
  FitMoments moments = nullptr;
};
[[nodiscard]] FitKernels fit_kernels(std::size_t numbers);

}  // namespace isolux::wide
