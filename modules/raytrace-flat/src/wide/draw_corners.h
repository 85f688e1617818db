#pragma once

#include <cstddef>
#include <cstdint>

namespace isolux::wide {

/// Draws of one of the eight corners of a box, side by side. A corner's bits: 1 is x, 2 is y, 4 is z.
struct CornerDraws {
  static constexpr std::size_t kMost = 16;

  float part[3][kMost];         ///< of the way from the lower corners to the upper ones, by axis
  float uniform[3][kMost];      ///< in [0, 1), one an axis
  float away[8][kMost];         ///< by corner, how far its isovalue is from what it is weighed by
  std::uint32_t corner[kMost];  ///< the result
};

/// Draws the first `count` corners by their trilinear weights; `by_isovalue`, times a weight that falls with `away`
/// over the range of the corners' isovalues and of what they are weighed by. That weight is never 0.
void draw_corners(CornerDraws& draws, std::size_t count, bool by_isovalue);

}  // namespace isolux::wide
