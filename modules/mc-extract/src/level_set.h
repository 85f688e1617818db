#pragma once

#include <isolux/mc_extract/extractor.h>
#include <isolux/mc_extract/vertex_resolution.h>

namespace isolux::mc {

/// What every backend agrees on: which side a value is on, where a vertex lies, which way faces turn.
///
/// *Inside* is the closed inner side: values at or above the isovalue for OuterSide::kLower, at or below it for
/// kHigher, so that negating field, isovalue and side changes nothing. A value equal to the isovalue thus counts as
/// just inside, as if the isovalue were moved outwards by an infinitesimal, and the vertices of its edges are kept
/// `margin` of an edge away from the grid point: strictly inside distinct edges, the three vertices of a triangle are
/// never on one line. That is a matter of index space, as affine maps keep lines: so the margin along each index axis
/// answers to what rounding world coordinates to float does along that axis, and to nothing else.
struct LevelSet {
  LevelSet(const Lattice& lattice, const ExtractSettings& settings);

  [[nodiscard]] bool inside(float value) const {
    return outer == OuterSide::kLower ? value >= isovalue : value <= isovalue;
  }
  /// Place of the vertex between two grid points of values a and b, the second `direction` bits (1 to 7: x, y, z and
  /// the diagonals) beyond the first: in [margin, 1 - margin], of a diagonal the largest margin of its axes; never NaN.
  [[nodiscard]] float fraction(float a, float b, int direction) const;

  float isovalue;
  OuterSide outer;
  Vec3f margin;   ///< vertex_margin() of the lattice
  bool mirrored;  ///< the frame's determinant is negative: triangles are turned round
};

}  // namespace isolux::mc
