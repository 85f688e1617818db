#include "sample_bins.h"

#include <cmath>

namespace isolux {
namespace {

/// Bounds the bins' memory on boxes that are far longer than wide.
constexpr int kMostBins = 2048;

}  // namespace

SampleBins::SampleBins(std::span<const Point> points, const Point& far_corner, double points_a_bin) {
  double volume = 1.0;
  float longest = 0.0f;
  for (int a = 0; a < 3; ++a) {
    volume *= double(far_corner.x[a]);
    longest = std::max(longest, far_corner.x[a]);
  }
  side_ = std::max(float(std::cbrt(volume * points_a_bin / double(points.size()))), longest / float(kMostBins));
  slack_ = 1e-6f * longest;
  for (std::size_t a = 0; a < 3; ++a) size_[a] = std::max(1, int(std::ceil(far_corner.x[a] / side_)));

  std::vector<std::size_t> bins(points.size());
  starts_.assign(bin_offset(0, 0, size_[2]) + 1, 0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto [i, j, k] = bin(points[p]);
    bins[p] = bin_offset(i, j, k);
    ++starts_[bins[p] + 1];
  }
  for (std::size_t b = 1; b < starts_.size(); ++b) starts_[b] += starts_[b - 1];
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  entries_.resize(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    entries_[next[bins[p]]++] = {.point = points[p], .sample = std::uint32_t(p)};
  }
}

std::array<int, 3> SampleBins::bin(const Point& p) const {
  std::array<int, 3> result{};
  for (std::size_t a = 0; a < 3; ++a) {
    const float b = p.x[a] / side_;
    result[a] = b > 0.0f ? int(std::min(b, float(size_[a] - 1))) : 0;
  }
  return result;
}

float SampleBins::distance_beyond(const Point& query, const std::array<int, 3>& centre, int r) const {
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t a = 0; a < 3; ++a) {
    if (centre[a] - r > 0) nearest = std::min(nearest, query.x[a] - float(centre[a] - r) * side_ - slack_);
    if (centre[a] + r < size_[a] - 1)
      nearest = std::min(nearest, float(centre[a] + r + 1) * side_ - query.x[a] - slack_);
  }
  return nearest;
}

}  // namespace isolux
