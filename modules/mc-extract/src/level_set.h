#pragma once

#include <isolux/mc_extract/extractor.h>

namespace isolux::mc {

/// What every backend agrees on: which side a value is on, where a vertex lies, which way faces turn.
///
/// *Inside* is the closed inner side: values at or above the isovalue for OuterSide::kLower, at or below it for
/// kHigher, so that negating field, isovalue and side changes nothing. A value equal to the isovalue thus counts as
/// just inside, as if the isovalue were moved outwards by an infinitesimal, and the vertices of its edges are kept
/// `margin` of an edge away from the grid point: strictly inside distinct edges, the three vertices of a triangle are
/// never on one line.
struct LevelSet {
  LevelSet(const Lattice& lattice, const ExtractSettings& settings);

  [[nodiscard]] bool inside(float value) const {
    return outer == OuterSide::kLower ? value >= isovalue : value <= isovalue;
  }
  /// Place of the vertex between two grid points of values a and b, in [margin, 1 - margin]; never NaN.
  [[nodiscard]] float fraction(float a, float b) const;

  float isovalue;
  OuterSide outer;
  /// 2^-10 of an edge, or 16 times the resolution of a float at the box's farthest coordinate where that is coarser, at
  /// most 1/4.
  float margin;
  bool mirrored;  ///< the frame's determinant is negative: triangles are turned round
};

}  // namespace isolux::mc
