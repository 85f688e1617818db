// Which cubes of cells are known to hold inner values only, against their definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "physics_support.h"
#include "wide/inner.h"

namespace isolux::test {
namespace {

/// The smallest of the cube's 27 grid points, values signed so that the inner side is the higher one.
float smallest_of(const Volume& volume, const Index3& cube, float sign) {
  float least = std::numeric_limits<float>::infinity();
  for (int k = 2 * cube.z; k <= 2 * cube.z + 2; ++k)
    for (int j = 2 * cube.y; j <= 2 * cube.y + 2; ++j)
      for (int i = 2 * cube.x; i <= 2 * cube.x + 2; ++i) least = std::min(least, sign * volume.values(i, j, k));
  return least;
}

void expect_bits(const Index3& size, OuterSide outer) {
  const Volume volume = noise(size, 9);
  const wide::FieldView field{volume.values.values().data(), size, outer};
  const float sign = outer == OuterSide::kLower ? 1.0f : -1.0f;
  // One ceiling is the very smallest value of a cube: that does not lie beyond it.
  std::vector<float> ceilings{-1.0f, -0.4f, -0.3f, -0.2f, 0.1f, smallest_of(volume, {0, 0, 0}, sign)};
  std::sort(ceilings.begin(), ceilings.end());
  const wide::InnerCodes codes(field, ceilings, isolux::Run{});
  for (std::size_t level = 0; level < ceilings.size(); ++level) {
    wide::InnerCubes inner(codes);
    inner.build(codes, int(level), isolux::Run{});
    const wide::InnerView view = inner.view();
    bool any = false;
    for (int k = 0; k < view.cubes.z; ++k) {
      for (int j = 0; j < view.cubes.y; ++j) {
        for (int i = 0; i < view.cubes.x; ++i) {
          const bool exists = 2 * i + 2 < size.x;  // rows are padded
          const bool expected = exists && smallest_of(volume, {i, j, k}, sign) > ceilings[level];
          any = any || expected;
          if (view.bits == nullptr) continue;
          const std::size_t at = (std::size_t(k) * view.cubes.y + j) * view.cubes.x + i;
          EXPECT_EQ((view.bits[at / 32] >> (at % 32) & 1u) != 0, expected) << i << " " << j << " " << k;
        }
      }
    }
    if (level == 0) {
      EXPECT_TRUE(any && view.bits != nullptr) << "nothing was compared";
    }
  }
}

TEST(InnerCubes, AreThoseWhoseCornersAllLieBeyondTheCeiling) {
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    expect_bits({70, 9, 12}, outer);
    expect_bits({33, 33, 5}, outer);
  }
}

TEST(InnerCubes, AreNotLookedAtWhereThereAreNone) {
  const Volume volume = noise({34, 18, 10}, 9);
  const wide::FieldView field{volume.values.values().data(), volume.lattice().size, OuterSide::kLower};
  const std::vector<float> ceilings{10.0f};  // above all values
  const wide::InnerCodes codes(field, ceilings, isolux::Run{});
  wide::InnerCubes inner(codes);
  inner.build(codes, 0, isolux::Run{});
  EXPECT_EQ(inner.view().bits, nullptr);
}

/// Fewer than two cells on an axis make no cube.
TEST(InnerCubes, AreNoneInASlabOfOneCell) {
  const Volume volume = noise({2, 20, 20}, 9);
  const wide::FieldView field{volume.values.values().data(), volume.lattice().size, OuterSide::kLower};
  const wide::InnerCodes codes(field, std::vector<float>{-10.0f}, isolux::Run{});
  wide::InnerCubes inner(codes);
  inner.build(codes, 0, isolux::Run{});
  EXPECT_EQ(inner.view().bits, nullptr);
}

}  // namespace
}  // namespace isolux::test
