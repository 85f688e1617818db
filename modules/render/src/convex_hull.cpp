#include <isolux/render/convex_hull.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isolux {
namespace {

using glm::dvec2;

/// Twice the area of a triangle, positive if its corners are counterclockwise.
double doubled_area(const dvec2& a, const dvec2& b, const dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

std::vector<dvec2> monotone_chain(std::vector<dvec2> points) {
  std::sort(points.begin(), points.end(),
            [](const dvec2& a, const dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 2) return points;
  std::vector<dvec2> hull;
  const auto extend = [&hull](const dvec2& point, std::size_t kept) {
    while (hull.size() >= kept + 2 && doubled_area(hull.end()[-2], hull.back(), point) <= 0.0) hull.pop_back();
    hull.push_back(point);
  };
  for (const dvec2& point : points) extend(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) extend(points[i], lower);
  hull.pop_back();  // the first again
  return hull;
}

constexpr int kStrips = 256;  // so narrow that they hold nearly all of a smooth hull

}  // namespace

void ConvexHull::add(const dvec2& point) {
  const double strip = (point.x - left_) * strips_a_unit_;
  if (strip >= 0.0 && strip < double(within_.size())) {
    const Heights& within = within_[std::size_t(strip)];
    if (point.y > within.low && point.y < within.high) return;
  }
  points_.push_back(point);
  if (points_.size() < most_points_) return;
  points_ = corners();
  most_points_ = 1024 + 2 * points_.size();
  find_within();
}

std::vector<dvec2> ConvexHull::corners() const { return monotone_chain(points_); }

void ConvexHull::find_within() {
  left_ = points_.front().x;
  const double right = std::ranges::max(points_, {}, &dvec2::x).x;
  strips_a_unit_ = kStrips / (right - left_);
  within_.clear();
  if (!std::isfinite(strips_a_unit_)) return;  // they are on one upright line
  // The hull's heights between two strips, from the edges that go right, which are below, and those that go left.
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<Heights> heights(kStrips + 1, {.low = kNone, .high = -kNone});
  dvec2 from = points_.back();
  for (const dvec2& to : points_) {
    const auto [first, last] = std::minmax(from.x, to.x);
    const int end = std::min(kStrips, int((last - left_) * strips_a_unit_));
    for (int i = int(std::ceil((first - left_) * strips_a_unit_)); first < last && i <= end; ++i) {
      const double x = std::clamp(left_ + i / strips_a_unit_, first, last);
      const double y = from.y + (to.y - from.y) * ((x - from.x) / (to.x - from.x));
      (from.x < to.x ? heights[std::size_t(i)].low : heights[std::size_t(i)].high) = y;
    }
    from = to;
  }
  // Convex: within a strip it reaches at least as far as at both its sides.
  for (std::size_t i = 0; i < kStrips; ++i)
    within_.push_back(
        {.low = std::max(heights[i].low, heights[i + 1].low), .high = std::min(heights[i].high, heights[i + 1].high)});
}

}  // namespace isolux
