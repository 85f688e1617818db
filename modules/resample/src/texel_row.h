#pragma once

#include <isolux/core/field_points.h>
#include <isolux/core/illumination_grid.h>

#include <cstddef>
#include <span>
#include <vector>

#include "near_field.h"

namespace isolux {

/// What the volume says of some texels of a row, one row after the other. `near_field` outlives it.
class TexelRow {
 public:
  TexelRow(const NearField& near_field, const Lattice& texels);

  /// Looks at the texels (i, j, k) of those columns i: from here on they are called by their place in the list.
  void look(int j, int k, std::span<const int> columns);
  /// Leaves those that are not in a flat part of the volume; the same of their columns.
  void keep_lit(std::vector<int>& columns);
  [[nodiscard]] double isovalue(std::size_t n) const { return texels_[n].isovalue; }
  [[nodiscard]] const NearField::Ahead& ahead(std::size_t n) const { return texels_[n].ahead; }

  /// The openness a step (as in NearFieldTerm) ahead of all of them.
  void find_openness(double step);
  [[nodiscard]] float openness(std::size_t n) const { return openness_[n]; }

 private:
  struct Texel {
    Vec3 index{0.0};  ///< of its centre
    double isovalue = 0.0;
    NearField::Ahead ahead;
  };

  const NearField& near_field_;
  IndexToWorld to_volume_;
  std::vector<Texel> texels_;
  std::vector<float> openness_;
  Points points_;
  PointSamples samples_;
  std::vector<double> values_;
};

}  // namespace isolux
