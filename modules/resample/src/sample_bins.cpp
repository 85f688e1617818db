#include "sample_bins.h"

#include <isolux/core/release.h>

namespace isolux {

SampleBins::SampleBins(std::span<const Point> points, const Point& far_corner, double points_a_bin)
    : bins_(points, far_corner, points_a_bin),
      slack_(1e-6f * std::max({far_corner.x[0], far_corner.x[1], far_corner.x[2]})) {
  entries_.reserve(points.size());
  for (const std::uint32_t p : bins_.points) entries_.push_back({.point = points[p], .sample = p});
  release(bins_.points);
}

float SampleBins::distance_beyond(const Point& query, const std::array<int, 3>& centre, int r) const {
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t a = 0; a < 3; ++a) {
    if (centre[a] - r > 0) nearest = std::min(nearest, query.x[a] - float(centre[a] - r) * bins_.side - slack_);
    if (centre[a] + r < bins_.size[a] - 1)
      nearest = std::min(nearest, float(centre[a] + r + 1) * bins_.side - query.x[a] - slack_);
  }
  return nearest;
}

}  // namespace isolux
