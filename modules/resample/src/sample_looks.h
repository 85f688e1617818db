#pragma once

#include <isolux/core/field_points.h>
#include <isolux/core/sample_set.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "near_field.h"

namespace isolux {

/// What the volume says of some sites, many at a time. `near_field` and `sites` outlive it.
class SampleLooks {
 public:
  SampleLooks(const NearField& near_field, const Sites& sites) : near_field_(near_field), sites_(sites) {}

  /// Looks at those sites: from here on they are called by their place in the list.
  void look(std::span<const std::uint32_t> sites);
  [[nodiscard]] const NearField::Ahead& ahead(std::size_t n) const { return ahead_[n]; }

  /// The openness a step (as in NearFieldTerm) ahead of all of them; 0 where there is no gradient.
  void find_openness(double step);
  [[nodiscard]] float openness(std::size_t n) const { return openness_[n]; }

 private:
  const NearField& near_field_;
  const Sites& sites_;
  std::span<const std::uint32_t> list_;
  Points points_;
  Points there_;
  PointSamples field_;
  std::vector<double> values_;
  std::vector<NearField::Ahead> ahead_;
  std::vector<float> openness_;
};

}  // namespace isolux
