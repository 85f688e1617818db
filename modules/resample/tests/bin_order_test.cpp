#include "bin_order.h"

#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <numeric>

namespace isolux {
namespace {

std::vector<Point> points_in(const Point& far_corner, std::size_t count) {
  std::vector<Point> points(count);
  for (std::size_t p = 0; p < count; ++p) {
    RandomStream random(1, p);
    for (std::size_t a = 0; a < 3; ++a) points[p].x[a] = random.uniform_float() * far_corner.x[a];
  }
  return points;
}

// Searches pass through empty bins: cubes that suit the volume of a sheet were a million times as many as points.
TEST(BinOrder, HasAboutOneBinForEachPointInBoxesOfAnyShape) {
  constexpr std::size_t kPoints = 500;
  for (const Point& box : {Point{{7, 7, 7}}, Point{{3e-5f, 3e3f, 3e3f}}, Point{{3e3f, 3e-5f, 3e3f}},
                           Point{{3e3f, 3e3f, 3e-5f}}, Point{{1e-6f, 1e-6f, 1e12f}}, Point{{1e12f, 0.0f, 1e-6f}},
                           Point{{1.0f, 4.0f, 400.0f}}, Point{{0.0f, 1e-38f, 1e38f}}}) {
    const BinOrder order(points_in(box, kPoints), box, 1.0);
    const std::size_t bins = order.starts.size() - 1;
    // Bins are cubes in whole numbers along each axis: of a box three bins thick they may be up to twice as many.
    EXPECT_LE(bins, 2 * kPoints) << box.x[0] << " " << box.x[1] << " " << box.x[2];
    EXPECT_GE(bins, kPoints / 2) << box.x[0] << " " << box.x[1] << " " << box.x[2];
    EXPECT_EQ(order.starts.back(), kPoints);
  }
}

}  // namespace
}  // namespace isolux
