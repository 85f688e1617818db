// Cases in which rounding would decide if the intersector let it: each with its exact answer.
#include <gtest/gtest.h>
#include <isolux/raytrace_flat/level_set_intersector.h>

#include <limits>

#include "physics_support.h"

namespace isolux::test {
namespace {

constexpr double kRoundings = 1e-12;  ///< some thousand roundings of a coordinate

Lattice whole(Index3 size) { return {.size = size, .frame = {}}; }

/// f = z on 5^3 grid points: level sets are planes, grid planes among them.
Volume ramp() {
  return sampled(whole(Index3(5)), [](const Vec3& p) { return p.z; });
}

std::optional<double> next(const Volume& volume, const Vec3& origin, const Vec3& direction,
                           OuterSide outer = OuterSide::kLower) {
  const auto isovalue = float(TrilinearField(volume).value(origin));
  const auto hit = LevelSetIntersector(volume).next_hit(origin, direction, isovalue, outer);
  return hit ? std::optional(hit->t) : std::nullopt;
}

std::optional<double> first(const Volume& volume, const Vec3& origin, const Vec3& direction, float isovalue) {
  const auto hit = LevelSetIntersector(volume).first_hit(origin, direction, isovalue);
  return hit ? std::optional(hit->t) : std::nullopt;
}

TEST(NastyRays, IntoTheInnerSideIsBlockedAtTheStartItself) {
  const Volume volume = ramp();
  for (const double z : {0.5, 1.0, 2.0, 3.25})
    for (const Vec3& way : {Vec3(0, 0, 1), Vec3(1, 0.3, 1e-9), Vec3(-1, -1, 1e-3), Vec3(0, 1, 5)})
      EXPECT_EQ(next(volume, {2.0, 1.5, z}, way), 0.0) << z;
}

TEST(NastyRays, AwayFromAPlaneLeaves) {
  const Volume volume = ramp();
  for (const double z : {0.5, 1.0, 2.0, 4.0})
    for (const Vec3& way : {Vec3(0, 0, -1), Vec3(1, 0.3, -1e-9), Vec3(-1, -1, -1e-3), Vec3(0, 1, -5)})
      EXPECT_EQ(next(volume, {2.0, 1.5, z}, way), std::nullopt) << z;
}

TEST(NastyRays, WithinAPlaneLevelSetIsNotAHit) {
  const Volume volume = ramp();
  for (const double z : {0.0, 0.5, 1.0, 2.0, 4.0})
    for (const Vec3& way : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(-3, 2, 0)})
      EXPECT_EQ(next(volume, {2.0, 2.0, z}, way), std::nullopt) << z;
}

TEST(NastyRays, TheOtherSideMirrorsEverything) {
  const Volume volume = ramp();
  EXPECT_EQ(next(volume, {2, 2, 1}, {0, 0, 1}, OuterSide::kHigher), std::nullopt);
  EXPECT_EQ(next(volume, {2, 2, 1}, {0, 0, -1}, OuterSide::kHigher), 0.0);
}

// f = |z - 2|: two planes, met at grid points, on faces, edges and corners of cells.
TEST(NastyRays, AlongAxesEdgesAndFacesToAGridPlane) {
  const Volume volume = sampled(whole(Index3(5)), [](const Vec3& p) { return std::abs(p.z - 2.0); });
  for (const Vec3& from : {Vec3(2, 2, 3), Vec3(2, 1.5, 3), Vec3(0, 0, 3), Vec3(4, 4, 3), Vec3(1.25, 2.75, 3)}) {
    EXPECT_EQ(next(volume, from, {0, 0, -1}), 2.0);
    EXPECT_EQ(next(volume, from, {0, 0, -0.125}), 16.0);
    EXPECT_EQ(next(volume, from, {0, 0, 1}), 0.0);
  }
  for (const double x : {-1.0, 1.0}) EXPECT_NEAR(*next(volume, {2, 2, 3}, {x, 0, -1}), 2.0, kRoundings);
  for (const double x : {-1.0, 1.0}) EXPECT_NEAR(*next(volume, {2, 2, 3}, {x, x, -1}), 2.0, kRoundings);
}

TEST(NastyRays, ExactPlacesOnTheBoxsFaces) {
  const Volume volume = ramp();
  // Out of the box at once, along its face, and into it.
  EXPECT_EQ(next(volume, {0, 2, 1}, {-1, 0, 0}), std::nullopt);
  EXPECT_EQ(next(volume, {4, 2, 1}, {1, 0, 1}), std::nullopt);
  EXPECT_EQ(next(volume, {4, 4, 1}, {0, 0, -1}), std::nullopt);
  EXPECT_EQ(next(volume, {4, 4, 1}, {0, 0, 1}), 0.0);
  EXPECT_EQ(next(volume, {4, 2, 1}, {-1, 0, 1}), 0.0);
}

TEST(NastyRays, AConstantCellIsNeverMetFromWithin) {
  const Volume volume = sampled(whole(Index3(3)), [](const Vec3&) { return 7.0; });
  EXPECT_EQ(next(volume, {0.3, 1.0, 1.7}, {0.3, 0.4, 0.5}), std::nullopt);
  EXPECT_EQ(next(volume, {1, 1, 1}, {1, 0, 0}), std::nullopt);
  EXPECT_EQ(first(volume, {-1, 1.1, 1.2}, {1, 0, 0}, 7.0f), 1.0);
  EXPECT_EQ(first(volume, {-1, 1.1, 1.2}, {1, 0, 0}, 6.0f), std::nullopt);
}

// A plateau of value 1 with a valley of value 0 in z = [0, 1] and a rise behind z = 3.
TEST(NastyRays, PlateausAreMetWhereTheyBegin) {
  const float profile[6] = {1, 0, 1, 1, 1, 2};
  const Volume volume = sampled(whole({3, 3, 6}), [&](const Vec3& p) { return profile[int(p.z)]; });
  // From the far wall of the valley to the plateau's edge.
  EXPECT_EQ(next(volume, {1, 1, 0}, {0, 0, 1}), 2.0);
  // On the plateau there is no side: it is met where it turns into the inner one.
  EXPECT_EQ(next(volume, {1, 1, 2.5}, {0, 0, 1}), 1.5);
  EXPECT_EQ(next(volume, {1, 1, 2}, {0, 0, 1}), 2.0);
  // Off the plateau, over the valley, to the far wall.
  EXPECT_EQ(next(volume, {1, 1, 2.5}, {0, 0, -1}), 2.5);
}

TEST(NastyRays, IsovaluesOfCornersAreMetAtTheCorners) {
  const Volume volume = noise(Index3(6), 3);
  for (int i = 1; i < 5; ++i) {
    const float isovalue = volume.values(2, i, 3);
    // Straight onto the corner along a grid line, from as near as no other root can lie before.
    const double before = volume.values(2, i - 1, 3);
    if (before == double(isovalue)) continue;
    EXPECT_NEAR(*first(volume, {2, i - 0.5, 3}, {0, 1, 0}, isovalue), 0.5, kRoundings);
  }
}

/// One cell of the given corner values, x fastest.
Volume cell(const float (&corners)[8], float factor = 1.0f) {
  return sampled(whole(Index3(2)),
                 [&](const Vec3& p) { return corners[int(p.x) + 2 * int(p.y) + 4 * int(p.z)] * factor; });
}

// Along the diagonal x = y of f = x (1 - y) + y (1 - x), 2 x (1 - x) touches 1/2 in the middle: a double root, on which
// rounding decides. The floats on both sides of it leave no doubt.
TEST(NastyRays, ADoubleRootIsFoundAFloatBelowItAndNotAFloatAbove) {
  const float corners[8] = {0, 1, 1, 0, 0, 1, 1, 0};
  const auto touched = first(cell(corners), {0, 0, 0.5}, {1, 1, 0}, std::nextafter(0.5f, 0.0f));
  ASSERT_TRUE(touched);
  EXPECT_NEAR(*touched, 0.5 - std::sqrt(0.5 * 0x1p-25), kRoundings);
  EXPECT_EQ(first(cell(corners), {0, 0, 0.5}, {1, 1, 0}, std::nextafter(0.5f, 1.0f)), std::nullopt);
}

// In the same cell f = x + y - 2 x y has a saddle in the middle; its level set 1/2 is the cross x = 1/2, y = 1/2.
TEST(NastyRays, SaddlesLetAndBlockAsTheirQuadrantsDo) {
  const float corners[8] = {0, 1, 1, 0, 0, 1, 1, 0};
  const Volume volume = cell(corners);
  const Vec3 center(0.5, 0.5, 0.5);
  EXPECT_EQ(next(volume, center, {1, -1, 0}), 0.0);            // up the ridge: tangent, then inside
  EXPECT_EQ(next(volume, center, {1, 1, 0.1}), std::nullopt);  // down the valley: tangent, then outside
  EXPECT_EQ(next(volume, center, {0, 0, 1}), std::nullopt);    // along the saddle line: on the level set
  EXPECT_EQ(next(volume, {0.25, 0.5, 0.5}, {0, -1, 0}), std::nullopt);
  EXPECT_EQ(next(volume, {0.25, 0.5, 0.5}, {0, 1, 0}), 0.0);
  // From one arm of the cross, through the lower quadrant, to the other arm.
  EXPECT_NEAR(*next(volume, {0.25, 0.5, 0.5}, {1, -1, 0}), 0.25, kRoundings);
}

TEST(NastyRays, HugeAndTinyValuesGiveTheSameRoots) {
  const float corners[8] = {0.25f, 1, -2, 3, 0.5f, -1.5f, 2, -0.75f};
  const Vec3 from(0.125, 0.25, 0.0625);
  const Vec3 way(0.7, 0.5, 0.9);
  for (const float factor : {1.0f, 0x1p100f, 0x1p-100f, -0x1p-120f}) {
    const Volume volume = cell(corners, factor);
    const OuterSide outer = factor > 0.0f ? OuterSide::kHigher : OuterSide::kLower;
    // A power of two changes no rounding at all.
    EXPECT_EQ(next(volume, from, way, outer), next(cell(corners), from, way, OuterSide::kHigher)) << factor;
  }
}

TEST(NastyRays, TheLengthOfTheDirectionOnlyScalesT) {
  const Volume volume = gyroid(16);
  const Vec3 from(3.3, 7.1, 5.9);
  const Vec3 way(0.3, -0.2, 0.8);
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    const auto t = next(volume, from, way, outer);
    for (const double length : {0x1p200, 0x1p-200, 0x1p20}) {
      const auto scaled = next(volume, from, way * length, outer);
      ASSERT_EQ(t.has_value(), scaled.has_value());
      if (!t) continue;
      EXPECT_NEAR(*scaled * length, *t, kRoundings);
    }
  }
}

TEST(NastyRays, DirectionsThatAreNoneMeetNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Vec3& way : {Vec3(0.0), Vec3(nan, 0, 1), Vec3(0, nan, 0), Vec3(0, infinity, 0)}) {
    EXPECT_EQ(next(ramp(), {2, 2, 2}, way), std::nullopt);
    EXPECT_EQ(first(ramp(), {2, 2, 2}, way, 1.0f), std::nullopt);
  }
}

TEST(NastyRays, CameraRaysMeetEitherSideAndMissBesideTheBox) {
  const Volume volume = ramp();
  EXPECT_EQ(first(volume, {2, 2, -10}, {0, 0, 1}, 1.5f), 11.5);
  EXPECT_EQ(first(volume, {2, 2, 10}, {0, 0, -2}, 1.5f), 4.25);
  EXPECT_EQ(first(volume, {2, 2, 1.5}, {0, 0, -2}, 1.5f), 0.0);
  EXPECT_EQ(first(volume, {2, 2, 10}, {0, 0, 1}, 1.5f), std::nullopt);
  EXPECT_EQ(first(volume, {5, 2, -1}, {0, 0, 1}, 1.5f), std::nullopt);
  EXPECT_EQ(first(volume, {4, 4, -1}, {0, 0, 1}, 1.5f), 2.5);
  // From a million away the entry is known to 1e-10 of a cell, and the root from there on exactly.
  EXPECT_NEAR(*first(volume, {2, 2 + 1e6, 1.5 + 1e6}, {0, -1, -1}, 1.5f), 1e6, 1e-9);
}

TEST(NastyRays, AShadowRayCountsHitsBeforeItsLimitOnly) {
  const Volume volume = sampled(whole(Index3(5)), [](const Vec3& p) { return std::abs(p.z - 2.0); });
  const LevelSetIntersector intersector(volume);
  const auto occluded = [&](double limit) {
    return intersector.is_occluded({2.2, 2.3, 3}, {0.1, 0.1, -1}, 1.0f, OuterSide::kLower, limit);
  };
  EXPECT_FALSE(occluded(0.5));
  EXPECT_FALSE(occluded(1.999));
  EXPECT_TRUE(occluded(2.001));
  EXPECT_TRUE(occluded(std::numeric_limits<double>::infinity()));
}

// A closed outer side: noise with a rim above every isovalue used. No ray gets out, however often it is reflected.
TEST(Leaks, NoRayEscapesAClosedLevelSet) {
  const long rays = full_stress() ? 100'000'000 : 200'000;
  const Index3 size(12, 9, 17);
  RandomStream random(11, 0);
  long escaped = 0;
  long off_surface = 0;
  for (long done = 0; done < rays;) {
    Volume volume = noise(size, random.next_bits());
    for (int k = 0; k < size.z; ++k)
      for (int j = 0; j < size.y; ++j)
        for (int i = 0; i < size.x; ++i)
          if (i == 0 || j == 0 || k == 0 || i == size.x - 1 || j == size.y - 1 || k == size.z - 1)
            volume.values(i, j, k) = 1.0f;
    const LevelSetIntersector intersector(volume);
    const TrilinearField field(volume);
    for (int path = 0; path < 2000; ++path) {
      Vec3 position;
      for (int a = 0; a < 3; ++a) position[a] = double(float(1.0 + random.uniform_double() * (size[a] - 3)));
      const auto isovalue = float(field.value(position));
      for (int bounce = 0; bounce < 10; ++bounce, ++done) {
        const auto hit = intersector.next_hit(position, random_direction(random), isovalue, OuterSide::kLower);
        if (!hit) {
          ++escaped;
          break;
        }
        position = hit->position;
        // A float's rounding of the isovalue, and the rounding of the coordinates times slopes of at most 3.
        if (std::abs(field.value(position) - double(isovalue)) > 1e-7) ++off_surface;
      }
    }
  }
  EXPECT_EQ(escaped, 0);
  EXPECT_EQ(off_surface, 0);
}

}  // namespace
}  // namespace isolux::test
