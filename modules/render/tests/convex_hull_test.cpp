// Convex hulls of points that come one after the other.
#include <gtest/gtest.h>
#include <isolux/core/random.h>
#include <isolux/render/convex_hull.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace isolux::test {
namespace {

using glm::dvec2;

std::vector<dvec2> corners_of(const std::vector<dvec2>& points) {
  ConvexHull hull;
  for (const dvec2& point : points) hull.add(point);
  return hull.corners();
}

/// The hull by gift wrapping: from corner to corner, each the one that has all others on its left. Whole numbers, so
/// that nothing is rounded.
std::vector<dvec2> wrapped(const std::vector<dvec2>& points) {
  std::vector<dvec2> corners{*std::min_element(points.begin(), points.end(), [](const dvec2& a, const dvec2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  })};
  while (true) {
    const dvec2 from = corners.back();
    dvec2 next = from;
    for (const dvec2& point : points) {
      const dvec2 a = next - from;
      const dvec2 b = point - from;
      const double turn = a.x * b.y - a.y * b.x;
      if (turn < 0.0 || (turn == 0.0 && glm::dot(b, b) > glm::dot(a, a))) next = point;
    }
    if (next == corners.front()) return corners;
    corners.push_back(next);
  }
}

/// Points of whole numbers in an ellipse that lies askew.
std::vector<dvec2> scattered(std::uint64_t seed, int count, double size) {
  RandomStream random(seed, 0);
  std::vector<dvec2> points;
  while (int(points.size()) < count) {
    const dvec2 p(2.0 * random.uniform_float() - 1.0, 2.0 * random.uniform_float() - 1.0);
    if (glm::dot(p, p) < 1.0) points.push_back(glm::round(size * dvec2(p.x + 3.0 * p.y, 2.0 * p.y + 1.0)));
  }
  return points;
}

TEST(ConvexHull, IsThatOfGiftWrapping) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    for (const double size : {1.0, 5.0, 1e5}) {
      for (const int count : {1, 2, 3, 4, 10, 100}) {
        const std::vector<dvec2> points = scattered(seed, count, size);
        EXPECT_EQ(corners_of(points), wrapped(points)) << seed << ' ' << size << ' ' << count;
      }
    }
  }
}

TEST(ConvexHull, LosesNoCornerOfManyPoints) {
  for (const double size : {1.0, 30.0, 1e5}) {
    std::vector<dvec2> points = scattered(7, 20000, size);
    const std::vector<dvec2> hull = wrapped(points);
    EXPECT_EQ(corners_of(points), hull);
    // Those of each batch beyond all before, and the other way round.
    std::sort(points.begin(), points.end(), [](const dvec2& a, const dvec2& b) { return a.x + a.y < b.x + b.y; });
    EXPECT_EQ(corners_of(points), hull);
    std::reverse(points.begin(), points.end());
    EXPECT_EQ(corners_of(points), hull);
  }
}

TEST(ConvexHull, KeepsAllOfACircle) {
  ConvexHull hull;
  constexpr int kCorners = 5000;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.4 * i;
    hull.add({std::cos(angle), std::sin(angle)});
  }
  EXPECT_EQ(int(hull.corners().size()), kCorners);
}

TEST(ConvexHull, OfALineIsItsEnds) {
  std::vector<dvec2> points;
  for (int i = 0; i < 5000; ++i) {
    const double place = i * 37 % 5000;
    points.emplace_back(3.0 * place, 7.0 - 2.0 * place);
  }
  EXPECT_EQ(corners_of(points), (std::vector<dvec2>{{0.0, 7.0}, {14997.0, -9991.0}}));
  for (dvec2& p : points) p.x = 5.0;
  EXPECT_EQ(corners_of(points), (std::vector<dvec2>{{5.0, -9991.0}, {5.0, 7.0}}));
}

TEST(ConvexHull, OfOnePointIsThatPoint) {
  EXPECT_TRUE(ConvexHull().empty());
  EXPECT_TRUE(ConvexHull().corners().empty());
  const std::vector<dvec2> points(5000, dvec2(-1.5, 2.0));
  EXPECT_EQ(corners_of(points), std::vector<dvec2>{points.front()});
}

}  // namespace
}  // namespace isolux::test
