#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace isolux {

/// The eight corner values of a cell (x fastest) and, on the way through it, the trilinear interpolant along a straight
/// segment: a cubic, kept by its Bernstein coefficients over the segment's parameter s in [0, 1]. The form is chosen
/// because it shows signs: a cubic with negative coefficients has no root, and no cancellation is needed to see it.
using CellCorners = std::array<double, 8>;

/// Bernstein coefficients of f along the segment from `enter` to `leave`, both in the cell's own coordinates [0, 1]^3:
/// blossoms of the trilinear form, hence means of the values at the corners of the segment's bounding box.
[[nodiscard]] std::array<double, 4> segment_cubic(const CellCorners& corners, const std::array<double, 3>& enter,
                                                  const std::array<double, 3>& leave);

/// f at a place of the cell, with the roundings of segment_cubic.
[[nodiscard]] double cell_value(const CellCorners& corners, const std::array<double, 3>& place);

/// The cubic at s.
[[nodiscard]] double cubic_at(const std::array<double, 4>& b, double s);

/// How much of a root is wanted.
enum class RootWish : unsigned char {
  kExists,  ///< any value in [0, 1] stands for "there is one"
  kPlace    ///< the first root itself, to the last bits
};

/// The first s in (0, 1] where the cubic, negative at 0, reaches zero. \pre b[0] < 0
[[nodiscard]] std::optional<double> first_root(const std::array<double, 4>& b, RootWish wish);

/// What a segment does that starts on the level set, its known root at s = 0 divided out.
struct DeflatedRoot {
  enum class Kind : unsigned char {
    kBlocked,  ///< goes straight into the inner side
    kHit,      ///< leaves on the outer side and meets the level set again at s
    kMiss,     ///< leaves on the outer side and stays there
    kFlat      ///< lies in the level set from end to end
  };
  Kind kind = Kind::kMiss;
  double s = 0.0;
};

/// Positive values of the cubic are the inner side. b[0] is taken for the rounding residual of zero.
[[nodiscard]] DeflatedRoot deflated_root(const std::array<double, 4>& b);

}  // namespace isolux
