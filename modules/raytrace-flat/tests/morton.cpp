// The curve along which strata of directions are neighbours.
#include "morton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wide/hemisphere.h"

namespace isolux::test {
namespace {

struct Placed {
  std::uint64_t place;
  std::uint32_t u;
  std::uint32_t v;
};

// Each square of the net's has as many of its points, so that the curve goes through one square after the other.
TEST(Morton, PointsOfANetThatFollowEachOtherFillSquares) {
  constexpr std::size_t kPoints = 1024;
  const wide::SobolPoints net(kPoints);
  std::vector<Placed> points;
  for (std::size_t i = 0; i < kPoints; ++i)
    points.push_back({.place = morton_place(net.u[i], net.v[i]), .u = net.u[i], .v = net.v[i]});
  std::sort(points.begin(), points.end(), [](const Placed& a, const Placed& b) { return a.place < b.place; });
  for (unsigned bits = 1; bits <= 5; ++bits) {  // of a square's place on an axis, the highest first
    const std::size_t in_square = kPoints >> (2 * bits);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const Placed& first = points[i / in_square * in_square];
      EXPECT_EQ(points[i].u >> (32 - bits), first.u >> (32 - bits)) << i << " of squares of " << in_square;
      EXPECT_EQ(points[i].v >> (32 - bits), first.v >> (32 - bits)) << i << " of squares of " << in_square;
    }
  }
}

TEST(Morton, PlacesAreThoseOfAllBits) {
  EXPECT_EQ(morton_place(0, 0), 0u);
  EXPECT_EQ(morton_place(0, 1), 1u);
  EXPECT_EQ(morton_place(1, 0), 2u);
  EXPECT_EQ(morton_place(0x80000000u, 0), std::uint64_t(1) << 63);
  EXPECT_EQ(morton_place(0xFFFFFFFFu, 0xFFFFFFFFu), ~std::uint64_t(0));
}

}  // namespace
}  // namespace isolux::test
