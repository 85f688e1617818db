#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

#include "bin_order.h"
#include "metric.h"
#include "neighbours.h"

namespace isolux {

/// Points in the order of bins. Searches visit shells of bins about the query until no bin beyond can hold anything
/// nearer (Bentley, Weide & Yao, "Optimal expected-time algorithms for closest point problems", 1980): expected
/// constant time where points are spread evenly.
class SampleBins {
 public:
  SampleBins(std::span<const Point> points, const Point& far_corner, double points_a_bin);

  /// The neighbours of `query` that `limits` asks for, nearest first.
  template <class Metric>
  void search(const Point& query, const NeighbourLimits& limits, std::vector<Neighbour>& found) const {
    NearestNeighbours nearest(limits, found);
    const std::array<int, 3> centre = bins_.bin(query);
    for (int r = 1;; ++r) {
      visit_shell<Metric>(query, centre, r, nearest);
      const float beyond = distance_beyond(query, centre, r);
      if (beyond == std::numeric_limits<float>::infinity()) break;
      if (beyond > 0.0f && Metric::axis(beyond) > nearest.worst_reach()) break;
    }
    nearest.finish();
  }

 private:
  struct Entry {
    Point point;
    std::uint32_t sample;
  };

  /// Less than the distance to any point outside the cube of bins of half edge r; infinite if there are none.
  [[nodiscard]] float distance_beyond(const Point& query, const std::array<int, 3>& centre, int r) const;

  /// Less than the distance along an axis from the query to a bin.
  [[nodiscard]] float gap(const Point& query, std::size_t axis, int bin, int centre) const {
    if (bin == centre) return 0.0f;
    const float to_bin =
        bin > centre ? float(bin) * bins_.side - query.x[axis] : query.x[axis] - float(bin + 1) * bins_.side;
    return std::max(to_bin - slack_, 0.0f);
  }

  /// Shell r, the first one together with the bin in the middle. Rows out of reach are left out.
  template <class Metric>
  void visit_shell(const Point& query, const std::array<int, 3>& centre, int r, NearestNeighbours& nearest) const {
    const int first = std::max(centre[0] - r, 0);
    const int last = std::min(centre[0] + r, bins_.size[0] - 1);
    for (int k = std::max(centre[2] - r, 0); k <= std::min(centre[2] + r, bins_.size[2] - 1); ++k) {
      const float reach_z = Metric::axis(gap(query, 2, k, centre[2]));
      for (int j = std::max(centre[1] - r, 0); j <= std::min(centre[1] + r, bins_.size[1] - 1); ++j) {
        const float reach_yz = Metric::join(Metric::axis(gap(query, 1, j, centre[1])), reach_z);
        if (reach_yz > nearest.bound()) continue;
        if (r == 1 || std::abs(j - centre[1]) == r || std::abs(k - centre[2]) == r) {
          visit_row<Metric>(query, first, last, j, k, nearest);
          continue;
        }
        if (centre[0] - r >= 0) visit_row<Metric>(query, first, first, j, k, nearest);
        if (centre[0] + r < bins_.size[0]) visit_row<Metric>(query, last, last, j, k, nearest);
      }
    }
  }

  template <class Metric>
  void visit_row(const Point& query, int first, int last, int j, int k, NearestNeighbours& nearest) const {
    const std::uint32_t end = bins_.starts[bins_.offset(last, j, k) + 1];
    for (std::uint32_t e = bins_.starts[bins_.offset(first, j, k)]; e < end; ++e) {
      nearest.offer(reach<Metric>(query, entries_[e].point), entries_[e].sample);
    }
  }

  BinOrder bins_;
  float slack_;  ///< more than rounding can move a point across a bin's side
  std::vector<Entry> entries_;
};

}  // namespace isolux
