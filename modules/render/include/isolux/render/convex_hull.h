#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

namespace isolux {

/// The convex hull of points of a plane that come one after the other: Andrew's monotone chain (Andrew 1979, "Another
/// efficient algorithm for convex hulls in two dimensions"). Keeps its corners and some thousand points at most.
/// Cost: a look into a table for most points within, a sort for the others.
class ConvexHull {
 public:
  void add(const glm::dvec2& point);
  [[nodiscard]] bool empty() const { return points_.empty(); }
  /// Counterclockwise from the least x (of these the least y), no three on a line but by rounding; none without points.
  [[nodiscard]] std::vector<glm::dvec2> corners() const;

 private:
  struct Heights {
    double low;
    double high;
  };
  void find_within();

  std::vector<glm::dvec2> points_;  ///< the corners of what came before, and what may be corners since
  std::size_t most_points_ = 1024;
  double left_ = 0.0;
  double strips_a_unit_ = 0.0;
  std::vector<Heights> within_;  ///< for upright strips from `left_` on: between these all is in the hull
};

}  // namespace isolux
