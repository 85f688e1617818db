// Which side of a level set the camera sees, and sides shown alone.
#include <gtest/gtest.h>
#include <isolux/render/render.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "analytic_volume.h"

namespace isolux::test {
namespace {

constexpr float kRadius = 0.3f;

/// Looks at the middle of the unit cube along +y, or from there.
Camera camera_from(const Vec3& eye) { return {.eye = eye}; }

/// What the shader was given at the middle of the picture.
std::optional<SurfacePoint> seen(const Volume& volume, const Camera& camera, OuterSide outer,
                                 std::optional<LevelSetSide> only, float isovalue) {
  std::optional<SurfacePoint> found;
  const Shader keep = [&](const SurfacePoint& point) {
    found = point;
    return Vec3f(0.0f);
  };
  const RenderSettings settings{
      .width = 1, .height = 1, .supersampling = 1, .isovalue = isovalue, .outer = outer, .only = only};
  Camera narrow = camera;
  narrow.half_height = 1e-3;  // all rays run through the middle
  static_cast<void>(render(volume, narrow, settings, keep, {.threads = 1}));
  return found;
}

// gen:sphere's outer side is outside the ball. The grid's ball is within 2e-3 of the round one.
TEST(Render, TellsWhichSideTheCameraSees) {
  const Volume ball = sphere(32);
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    const bool lower = outer == OuterSide::kLower;
    const auto from_outside = seen(ball, camera_from({0.5, -2.0, 0.5}), outer, {}, -kRadius);
    ASSERT_TRUE(from_outside.has_value());
    EXPECT_EQ(from_outside->outside, lower);
    EXPECT_NEAR(from_outside->world.y, 0.5 - double(kRadius), 2e-3);
    const auto from_within = seen(ball, camera_from(Vec3(0.5)), outer, {}, -kRadius);
    ASSERT_TRUE(from_within.has_value());
    EXPECT_EQ(from_within->outside, !lower);
    EXPECT_NEAR(from_within->world.y, 0.5 + double(kRadius), 2e-3);
  }
}

TEST(Render, LooksThroughTheSideThatIsNotShown) {
  const Volume ball = sphere(32);
  const Camera camera = camera_from({0.5, -2.0, 0.5});
  const auto outer = seen(ball, camera, OuterSide::kLower, LevelSetSide::kOuter, -kRadius);
  const auto inner = seen(ball, camera, OuterSide::kLower, LevelSetSide::kInner, -kRadius);
  ASSERT_TRUE(outer.has_value());
  ASSERT_TRUE(inner.has_value());
  EXPECT_TRUE(outer->outside);
  EXPECT_NEAR(outer->world.y, 0.5 - double(kRadius), 2e-3);
  EXPECT_FALSE(inner->outside);
  EXPECT_NEAR(inner->world.y, 0.5 + double(kRadius), 2e-3);
  EXPECT_NEAR(inner->normal.y, 1.0, 1e-3);  // normals stay the outer side's
  // From within there is nothing but the inner side.
  EXPECT_FALSE(seen(ball, camera_from(Vec3(0.5)), OuterSide::kLower, LevelSetSide::kOuter, -kRadius).has_value());
}

TEST(Render, ShadesEachSideWithItsOwnLight) {
  const auto constant = [](float e) { return [e](const SurfacePoint&) { return Vec3f(e); }; };
  const Shader both = global_shader(constant(0.5f), constant(0.25f), {});
  SurfacePoint point;
  EXPECT_EQ(both(point), Vec3f(0.4f));
  point.outside = false;
  EXPECT_EQ(both(point), Vec3f(0.2f));
  const Shader shining = global_shader(constant(0.5f), {.albedo = Vec3f(0.5f), .emission = Vec3f(0.0f, 0.25f, 0.5f)});
  point.outside = true;
  EXPECT_EQ(shining(point), Vec3f(0.25f, 0.5f, 0.75f)) << "what leaves the surface: albedo times e and emission";
}

}  // namespace
}  // namespace isolux::test
