#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "texel_pyramid.h"

namespace isolux {

/// Rays of a texel when it is first traced: a corner of the largest cells, or where all texels are traced.
inline constexpr int kFirstRaysByNeed = 16;
/// Rays of a corner of smaller cells: light changes there, and fewer would not tell where.
inline constexpr int kRaysByNeed = 32;

/// Mean squared error of a cell's texels, by the figures of the cell.
[[nodiscard]] double squared_error(const CellFigures& figures, int level);

/// What is done next: cells that fall apart into eight, and traced texels whose rays are doubled.
struct NeedSteps {
  std::vector<TexelPyramid::Cell> refined;
  std::vector<std::uint32_t> doubled;  ///< places in TexelPyramid::texels(), rising
  double single_part = 0.0;            ///< of all texels in cells, those that are traced each once this is done
};

/// The steps that take away most squared error for a ray, as many as bring the error to `goal` times what it is, by the
/// figures, and at least one of fifty: none only where none helps. Cost: some .2 microseconds a traced texel.
[[nodiscard]] NeedSteps choose_steps(const TexelPyramid& pyramid, double goal, const Run& run);

}  // namespace isolux
