#pragma once

#include <isolux/core/field.h>
#include <isolux/core/run.h>
#include <isolux/core/volume.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// How high one has to go on the way out of a volume's box, from every grid point: the least, over all ways, of the
/// highest value that is passed. What lies below an isovalue and is not let out by that is a pocket. Ways go along the
/// grid's edges and, through saddles of the trilinear field, from corner to corner of a cell's faces and of the cell;
/// within a cell saddles are looked for in nine slices across each axis. Found by flooding from the box's faces in the
/// order of levels (Barnes, Lehman & Mulla, "Priority-flood", 2014), in 2^16 steps of the field's range, rounded down.
/// 2 bytes a grid point, some 12 while it is made; some tenths of a microsecond of one thread each. With the higher
/// values outside, the same of the field turned upside down.
class PassLevels {
 public:
  /// Looks at the volume, which outlives it. \pre require_usable(volume), fewer than 2^32 grid points. \throw Cancelled
  PassLevels(const Volume& volume, OuterSide outer, const Run& run);

  /// Whether nothing leads out of the box from the outer side of an isovalue's level set at a point of it (index space)
  /// but through that level set.
  [[nodiscard]] bool is_closed(const Vec3f& index, float isovalue) const;

 private:
  class Flood;

  /// Whether any corner of a cell is below a level, in steps, and let out by it.
  [[nodiscard]] bool lets_out(const Index3& cell, double level) const;

  Lattice lattice_;
  std::span<const float> values_;
  double sign_;  ///< of values, so that the outer side is the lower one
  double low_ = 0.0;
  double step_ = 0.0;  ///< between levels; 0 where all values are the same
  std::vector<std::uint16_t> levels_;
};

}  // namespace isolux
