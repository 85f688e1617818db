#pragma once

#include <cstddef>
#include <cstdint>

namespace isolux::wide {

/// A lattice of points and the way to it from another index space.
struct PointGrid {
  float axes[3][3];  ///< row, column
  float origin[3];
  std::uint32_t size[3];
};

/// Draws of one of the eight grid points around a place, side by side. A corner's bits: 1 is x, 2 is y, 4 is z.
struct CornerDraws {
  static constexpr std::size_t kMost = 16;

  float index[3][kMost];        ///< places, by axis
  std::uint32_t lowest[kMost];  ///< of the eight points, x fastest
  float part[3][kMost];         ///< of the way from the lower corners to the upper ones, by axis
  float uniform[3][kMost];      ///< in [0, 1), one an axis
  float away[8][kMost];         ///< by corner, how far its isovalue is from what it is weighed by
  float likeness[8][kMost];     ///< by corner, a factor of its weight
  std::uint32_t corner[kMost];  ///< the result
};

/// Finds the points around the first `count` places: `lowest` and `part` from `index`. Places outside count as on the
/// faces. \pre fewer than 2^32 points
void find_corners(CornerDraws& draws, std::size_t count, const PointGrid& grid);

/// By what corners are drawn besides their trilinear weights.
struct CornerWeights {
  bool isovalue = false;  ///< a weight that falls with `away` over the range of the corners' isovalues and of what they
                          ///< are weighed by, and is never 0
  bool likeness = false;
};

/// Draws the first `count` corners.
void draw_corners(CornerDraws& draws, std::size_t count, const CornerWeights& by);

}  // namespace isolux::wide
