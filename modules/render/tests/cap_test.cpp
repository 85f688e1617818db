// Surfaces that are closed at the box, and parts of them that are looked through.
#include <gtest/gtest.h>
#include <isolux/render/render.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "analytic_volume.h"

namespace isolux::test {
namespace {

/// What the shader is given along one line: the middle of an orthographic picture.
std::optional<SurfacePoint> met(const Volume& volume, const Vec3& eye, const Vec3& forward, RenderSettings settings) {
  std::optional<SurfacePoint> found;
  const Shader keep = [&](const SurfacePoint& point) {
    found = point;
    return Vec3f(0.0f);
  };
  settings.width = settings.height = settings.supersampling = 1;
  const Vec3 up = std::fabs(forward.z) > 0.5 ? Vec3(0.0, 1.0, 0.0) : Vec3(0.0, 0.0, 1.0);
  const Vec3 right = glm::normalize(glm::cross(forward, up));
  const Camera camera{.eye = eye,
                      .forward = glm::normalize(forward),
                      .right = right,
                      .up = glm::normalize(glm::cross(right, forward)),
                      .half_height = 1e-6,
                      .projection = Projection::kOrthographic};
  static_cast<void>(render(volume, camera, settings, keep, {.threads = 1}));
  return found;
}

// A ball that the box cuts: |p - c| <= .6 is inside, all of the faces' middles are.
TEST(Cap, IsSeenWhereTheInsideMeetsTheBox) {
  const Volume ball = sphere(33);
  RenderSettings settings{.isovalue = -0.6f};
  for (int face = 0; face < 6; ++face) {
    Vec3 outward(0.0);
    outward[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
    const Vec3 middle = Vec3(0.5) + 0.5 * outward + Vec3(0.01, 0.02, 0.03) * (1.0 - glm::abs(outward));
    const Vec3 eye = middle + outward;
    settings.cap = false;
    EXPECT_FALSE(met(ball, eye, -outward, settings).has_value()) << "open: no surface on that line";
    settings.cap = true;
    const auto cap = met(ball, eye, -outward, settings);
    ASSERT_TRUE(cap.has_value());
    EXPECT_EQ(cap->cap, face);
    EXPECT_TRUE(cap->outside);
    EXPECT_LT(glm::distance(cap->world, middle), 1e-5);
    EXPECT_LT(glm::distance(cap->normal, outward), 1e-12);
    // From the ball's middle the inner side of the opposite cap is seen.
    const auto from_within = met(ball, Vec3(0.5), -outward, settings);
    ASSERT_TRUE(from_within.has_value());
    EXPECT_EQ(from_within->cap, face ^ 1);
    EXPECT_FALSE(from_within->outside);
    EXPECT_LT(glm::distance(from_within->normal, -outward), 1e-12);
    // Its outer side alone: nothing stands in the way of looking out.
    settings.only = LevelSetSide::kOuter;
    EXPECT_FALSE(met(ball, Vec3(0.5), -outward, settings).has_value());
    EXPECT_TRUE(met(ball, eye, -outward, settings)->outside);
    settings.only.reset();
  }
}

// Beyond the rim, at a corner of a face, the box is open: what is seen is the surface.
TEST(Cap, LeavesTheSurfaceAlone) {
  const Volume ball = sphere(33);
  const auto seen = met(ball, {0.12, -1.0, 0.12}, {0.0, 1.0, 0.0}, {.isovalue = -0.6f, .cap = true});
  ASSERT_TRUE(seen.has_value());
  EXPECT_FALSE(seen->cap.has_value());
  EXPECT_GT(seen->world.y, 0.05);
}

TEST(Cap, ClosesTheOtherSideWhereTheInnerSideAloneIsShown) {
  const Volume ball = sphere(33);
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    // What is outside the ball, whatever it is called.
    const LevelSetSide side = outer == OuterSide::kLower ? LevelSetSide::kInner : LevelSetSide::kOuter;
    const RenderSettings settings{.isovalue = -0.6f, .outer = outer, .only = side, .cap = true};
    const auto corner = met(ball, {0.12, -1.0, 0.12}, {0.0, 1.0, 0.0}, settings);
    ASSERT_TRUE(corner.has_value());
    EXPECT_EQ(corner->cap, 2);
    EXPECT_EQ(corner->outside, outer == OuterSide::kHigher);
    // Normals are the outer side's, into the box where that is what the surface is called outside.
    EXPECT_LT(glm::distance(corner->normal, Vec3(0.0, outer == OuterSide::kHigher ? -1.0 : 1.0, 0.0)), 1e-12);
    EXPECT_FALSE(met(ball, {0.5, -1.0, 0.5}, {0.0, 1.0, 0.0}, settings)) << "through the ball, open on both sides";
  }
}

TEST(Cap, HasTheNormalOfAnObliqueFace) {
  Lattice lattice{.size = Index3(9), .frame = {}};
  lattice.frame.axes = Mat3(0.125);
  lattice.frame.axes[1] = Vec3(0.05, 0.125, 0.0);
  const Volume full = sampled(lattice, [](const Vec3&) { return 1.0; });
  const auto cap = met(full, lattice.frame.world({4.0, 4.0, 4.0}) - Vec3(3.0, 0.0, 0.0), {1.0, 0.0, 0.0},
                       {.isovalue = 0.0f, .cap = true});
  ASSERT_TRUE(cap.has_value());
  EXPECT_EQ(cap->cap, 0);
  EXPECT_NEAR(glm::dot(cap->normal, lattice.frame.axes[1]), 0.0, 1e-12);
  EXPECT_NEAR(glm::dot(cap->normal, lattice.frame.axes[2]), 0.0, 1e-12);
  EXPECT_LT(cap->normal.x, 0.0);
}

// The part x >= .45 of the unit cube, seen from the front: .55 of its face.
TEST(Cap, CoversWhatIsInside) {
  const Volume ramp = unit_cube_volume(11, [](const Vec3& p) { return p.x; });
  RenderSettings settings{.width = 100, .height = 100, .supersampling = 3, .isovalue = 0.45f, .cap = true};
  settings.background.reset();
  const Camera camera = orbit_camera(
      ramp.lattice(), {.azimuth_deg = 0.0, .elevation_deg = 0.0, .projection = Projection::kOrthographic}, 1.0);
  const Image image = render(ramp, camera, settings, normal_shader(), {});
  double covered = 0.0;
  for (const float c : image.coverage) covered += double(c);
  EXPECT_NEAR(covered / 1e4, 0.55, 0.004);  // the edge is within a ray of each of 100 rows
}

TEST(LeftOut, IsLookedThrough) {
  const Volume ball = sphere(33);
  RenderSettings settings{.isovalue = -0.3f};
  settings.left_out = [](const Vec3& index) { return index.y < 16.0; };
  const auto behind = met(ball, {0.5, -1.0, 0.5}, {0.0, 1.0, 0.0}, settings);
  ASSERT_TRUE(behind.has_value());
  EXPECT_NEAR(behind->world.y, 0.8, 2e-3);
  EXPECT_FALSE(behind->outside) << "through the near half the far one is seen from within";
  // A cap as well.
  settings = {.isovalue = -0.6f, .cap = true, .left_out = settings.left_out};
  const auto far_cap = met(ball, {0.5, -1.0, 0.5}, {0.0, 1.0, 0.0}, settings);
  ASSERT_TRUE(far_cap.has_value());
  EXPECT_EQ(far_cap->cap, 3);
  EXPECT_FALSE(far_cap->outside);
  settings.left_out = [](const Vec3&) { return true; };
  EXPECT_FALSE(met(ball, {0.5, -1.0, 0.5}, {0.0, 1.0, 0.0}, settings).has_value());
}

TEST(Cap, HasNoLightOnItsInnerSide) {
  const auto bright = [](const SurfacePoint&) { return Vec3f(1.0f); };
  SurfacePoint point{.normal = {0.0, 0.0, 1.0}, .towards_eye = {0.0, 0.0, -1.0}, .outside = false};
  const Shader shader = global_shader(bright, bright, {});
  EXPECT_EQ(shader(point), Vec3f(0.8f));
  point.cap = 5;
  EXPECT_LT(shader(point).x, 0.1f);
  EXPECT_GT(shader(point).x, 0.0f);
  point.outside = true;
  EXPECT_EQ(shader(point), Vec3f(0.8f));
}

}  // namespace
}  // namespace isolux::test
