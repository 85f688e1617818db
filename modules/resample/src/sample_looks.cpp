#include "sample_looks.h"

namespace isolux {

void SampleLooks::look(std::span<const std::uint32_t> sites) {
  list_ = sites;
  points_.resize(sites.size());
  for (std::size_t n = 0; n < sites.size(); ++n) points_.set(n, Vec3(sites_.positions[sites[n]]));
  sample_field(near_field_.field(), points_, field_);
  ahead_.resize(sites.size());
  for (std::size_t n = 0; n < sites.size(); ++n) ahead_[n] = near_field_.ahead_of(field_.gradient(n));
}

void SampleLooks::find_openness(double step) {
  there_.resize(list_.size());
  for (std::size_t n = 0; n < list_.size(); ++n) there_.set(n, points_.at(n) + step * ahead_[n].step);
  sample_values(near_field_.field(), there_, values_);
  openness_.resize(list_.size());
  for (std::size_t n = 0; n < list_.size(); ++n) {
    const auto isovalue = double(sites_.isovalues[list_[n]]);
    openness_[n] = ahead_[n].fall > 0.0 ? NearField::openness_of(values_[n], ahead_[n], isovalue, step) : 0.0f;
  }
}

}  // namespace isolux
