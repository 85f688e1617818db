// CGAL's spatial searching is under the GPL: it stays in this file (third_party_notes/cgal.md).
#include <CGAL/Kd_tree.h>
#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits.h>

#include <cmath>
#include <vector>

#include "shepard_choice.h"
#include "shepard_resample.h"

namespace isolux::backends {
namespace {

struct TreePoint {
  Point place{};
  std::uint32_t sample = 0;
};

struct CoordinatesOf {
  using result_type = const float*;
  const float* operator()(const TreePoint& p) const { return p.place.x; }
  const float* operator()(const TreePoint& p, int /*end*/) const { return p.place.x + 4; }
};

using Traits = CGAL::Search_traits<double, TreePoint, const float*, CoordinatesOf, CGAL::Dimension_tag<4>>;

/// A metric as CGAL's orthogonal search wants it, its "transformed distance" being the reach.
template <class Metric>
class TreeDistance {
 public:
  using FT = double;
  using Point_d = TreePoint;
  using Query_item = TreePoint;
  using D = CGAL::Dimension_tag<4>;

  // The names are CGAL's.
  // NOLINTBEGIN(readability-identifier-naming)
  [[nodiscard]] double transformed_distance(const TreePoint& p, const TreePoint& q) const {
    return double(reach<Metric>(p.place, q.place));
  }

  template <class Rectangle>
  [[nodiscard]] double min_distance_to_rectangle(const TreePoint& p, const Rectangle& box) const {
    std::vector<double> steps(4);
    return min_distance_to_rectangle(p, box, steps);
  }

  template <class Rectangle>
  [[nodiscard]] double min_distance_to_rectangle(const TreePoint& p, const Rectangle& box,
                                                 std::vector<double>& steps) const {
    float result = 0.0f;
    for (int a = 0; a < 4; ++a) {
      const auto x = double(p.place.x[a]);
      const double step = x < box.min_coord(a) ? box.min_coord(a) - x : std::max(x - box.max_coord(a), 0.0);
      steps[std::size_t(a)] = step;
      result = Metric::join(result, Metric::axis(float(step)));
    }
    return kCaution * double(result);
  }

  template <class Rectangle>
  [[nodiscard]] double max_distance_to_rectangle(const TreePoint& p, const Rectangle& box,
                                                 std::vector<double>& steps) const {
    float result = 0.0f;
    for (int a = 0; a < 4; ++a) {
      const auto x = double(p.place.x[a]);
      steps[std::size_t(a)] = std::max(x - box.min_coord(a), box.max_coord(a) - x);
      result = Metric::join(result, Metric::axis(float(steps[std::size_t(a)])));
    }
    return double(result);
  }

  /// The step to a box along one axis grew from `before` to `now`: sums exchange the two, a maximum only grows.
  [[nodiscard]] double new_distance(double reach_before, double before, double now, int /*axis*/) const {
    if constexpr (std::is_same_v<Metric, ChebyshevMetric>) return std::max(reach_before, kCaution * std::fabs(now));
    const auto part = [](double step) {
      return std::is_same_v<Metric, EuclideanMetric> ? step * step : std::fabs(step);
    };
    return reach_before + kCaution * (part(now) - part(before));
  }

  [[nodiscard]] double transformed_distance(double distance) const { return std::pow(distance, 1.0 / Metric::kPower); }
  [[nodiscard]] double inverse_of_transformed_distance(double reach) const { return std::pow(reach, Metric::kPower); }
  // NOLINTEND(readability-identifier-naming)

 private:
  /// Boxes count as nearer than they are by more than a reach is rounded, or equally near samples might be missed.
  static constexpr double kCaution = 1.0 - 1e-6;
};

template <class Metric>
class Tree {
 public:
  using Search = CGAL::Orthogonal_k_neighbor_search<Traits, TreeDistance<Metric>>;

  explicit Tree(const ShepardSpace& space) : limits_(space.limits()) {
    std::vector<TreePoint> points;
    points.reserve(space.samples().size());
    for (const Point& p : space.samples()) points.push_back({.place = p, .sample = std::uint32_t(points.size())});
    tree_.insert(points.begin(), points.end());
    tree_.build();
  }

  void search(const Point& query, std::vector<Neighbour>& found) const {
    const std::size_t all = tree_.size();
    // CGAL takes any of equally near samples. One more than asked for tells whether there is a choice, and then more
    // are fetched until the farthest is beyond doubt.
    std::size_t fetched = std::min(limits_.count < all ? limits_.count + 1 : kFirstFetch, all);
    for (;; fetched = std::min(2 * fetched, all)) {
      NearestNeighbours nearest(limits_, found);
      const Search search(tree_, {.place = query, .sample = 0}, unsigned(fetched));
      float farthest = 0.0f;
      for (const auto& [point, distance] : search) {
        farthest = std::max(farthest, float(distance));
        nearest.offer(float(distance), point.sample);
      }
      const bool complete = fetched == all || farthest > nearest.worst_reach();
      if (!complete) continue;
      nearest.finish();
      return;
    }
  }

 private:
  static constexpr std::size_t kFirstFetch = 64;

  NeighbourLimits limits_;
  typename Search::Tree tree_;
};

class CgalKdTree final : public Resampler {
 public:
  using Options = ShepardOptions;
  explicit CgalKdTree(const Options& options) : options_(options) {}

  ResampledGrid resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                         const Run& run) const override {
    const ShepardOptions options = chosen_by_samples(options_, volume, samples, run);
    const ShepardSpace space(volume, samples, options);
    return with_metric(options.distance, [&](auto metric) {
      const Tree<decltype(metric)> tree(space);
      const auto search = [&](const Point& query, std::vector<Neighbour>& found) { tree.search(query, found); };
      return shepard_resample(volume, samples, texels, options, space, search, run);
    });
  }

 private:
  Options options_;
};

}  // namespace

void cgal_kdtree(Registry<Resampler>& registry) {
  registry.add<CgalKdTree>("cgal_kdtree",
                           "Shepard's interpolation, neighbours found in CGAL's kd-tree (GPL: see third_party_notes)");
}

}  // namespace isolux::backends
