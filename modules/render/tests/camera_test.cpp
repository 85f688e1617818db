// Where cameras stand, and what is in view.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/core/random.h>
#include <isolux/render/render.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "analytic_volume.h"

namespace isolux::test {
namespace {

constexpr double kAspect = 1.5;
constexpr float kBall = 0.3f;

/// Where a point is seen: x from -aspect to aspect, y from -1 to 1.
Vec3 place_of(const Camera& camera, const Vec3& world) {
  const Vec3 p = world - camera.eye;
  const double depth = glm::dot(p, camera.forward);
  const double scale = camera.half_height * (camera.projection == Projection::kPerspective ? depth : 1.0);
  return {glm::dot(p, camera.right) / scale, glm::dot(p, camera.up) / scale, depth};
}

const auto kProjections = {Projection::kPerspective, Projection::kOrthographic};

TEST(Camera, HasTheUpThatIsAsked) {
  const Lattice box{.size = Index3(9), .frame = {}};
  for (const Vec3& up : {Vec3(0, 0, 2), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(-3, 0, 0), Vec3(0, 0, -1), Vec3(1, 2, 3)}) {
    const Camera level = orbit_camera(box, {.azimuth_deg = 0.0, .elevation_deg = 0.0, .up = up}, kAspect);
    EXPECT_LT(glm::distance(level.up, glm::normalize(up)), 1e-12);
    EXPECT_LT(glm::distance(glm::cross(level.right, level.forward), level.up), 1e-12);
    const Camera above = orbit_camera(box, {.azimuth_deg = 40.0, .elevation_deg = 90.0, .up = up}, kAspect);
    EXPECT_LT(glm::distance(above.forward, -glm::normalize(up)), 1e-12);
  }
  const Camera y_up = orbit_camera(box, {.azimuth_deg = 0.0, .elevation_deg = 0.0, .up = {0, 1, 0}}, kAspect);
  EXPECT_LT(glm::distance(y_up.forward, Vec3(0, 0, -1)), 1e-12);
  EXPECT_LT(glm::distance(y_up.right, Vec3(1, 0, 0)), 1e-12);
  EXPECT_THROW((void)orbit_camera(box, {.up = Vec3(0.0)}, kAspect), InvalidInput);
}

TEST(Camera, OfTheBoxHasAllOfItInView) {
  const Lattice box{.size = {9, 5, 30}, .frame = {.origin = {100.0, -7.0, 3.0}, .axes = Mat3(0.3)}};
  for (const Projection projection : kProjections) {
    const Camera camera = orbit_camera(box, {.projection = projection}, kAspect);
    double reach = 0.0;
    for (int c = 0; c < 8; ++c) {
      const Vec3 corner = box.frame.world(Vec3(box.size - 1) * Vec3(c & 1, c >> 1 & 1, c >> 2));
      const Vec3 seen = place_of(camera, corner);
      EXPECT_GE(seen.z, -1e-9);
      reach = std::max({reach, std::fabs(seen.x) / kAspect, std::fabs(seen.y)});
    }
    EXPECT_NEAR(reach, 1.0, 1e-9);
  }
}

// Of wide pictures and of deep points alike.
TEST(Camera, FramesPointsInTheMiddle) {
  for (int seed = 0; seed < 20; ++seed) {
    RandomStream random(std::uint64_t(seed), 1);
    std::vector<Vec3f> points(20);
    for (Vec3f& p : points)
      for (int a = 0; a < 3; ++a) p[a] = float(5 * a + 1) * random.uniform_float();
    for (const double aspect : {0.2, 1.0, 5.0}) {
      for (const Projection projection : kProjections) {
        const View view{.azimuth_deg = 50.0 * seed, .elevation_deg = 8.0 * seed - 70.0, .projection = projection};
        const Camera camera = framing_camera(points, view, aspect);
        Vec3 low(1e9);
        Vec3 high(-1e9);
        for (const Vec3f& p : points) {
          const Vec3 seen = place_of(camera, Vec3(p));
          low = glm::min(low, seen);
          high = glm::max(high, seen);
        }
        EXPECT_NEAR(low.x, -high.x, 1e-9);
        EXPECT_NEAR(low.y, -high.y, 1e-9);
      }
    }
  }
}

TEST(Camera, FramesPointsFromSideToSide) {
  for (int seed = 0; seed < 20; ++seed) {
    RandomStream random(std::uint64_t(seed), 0);
    std::vector<Vec3f> points(50);
    for (Vec3f& p : points)
      for (int a = 0; a < 3; ++a) p[a] = 300.0f + float(a + 1) * random.uniform_float();
    for (const Projection projection : kProjections) {
      const View view{.azimuth_deg = 50.0 * seed, .elevation_deg = 8.0 * seed - 70.0, .projection = projection};
      const Camera camera = framing_camera(points, view, kAspect);
      Vec3 low(1e9);
      Vec3 high(-1e9);
      for (const Vec3f& p : points) {
        const Vec3 seen = place_of(camera, Vec3(p)) / Vec3(kAspect, 1.0, 1.0);
        low = glm::min(low, seen);
        high = glm::max(high, seen);
      }
      EXPECT_GT(low.z, 0.0);
      EXPECT_GE(std::min(low.x, low.y), -0.98 - 1e-9);
      EXPECT_LE(std::max(high.x, high.y), 0.98 + 1e-9);
      EXPECT_TRUE((low.x < -0.9799 && high.x > 0.9799) || (low.y < -0.9799 && high.y > 0.9799)) << seed;
    }
  }
  EXPECT_THROW((void)framing_camera({}, {}, kAspect), InvalidInput);
}

TEST(Camera, FramesPointsThatComeBitByBit) {
  const std::vector<Vec3f> points = {{0, 0, 0}, {1, 2, 3}, {-4, 1, 0}, {2, -3, 5}};
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    const View view{.projection = projection};
    Framing framing(view, kAspect);
    EXPECT_TRUE(framing.empty());
    EXPECT_THROW((void)framing.camera(), InvalidInput);
    framing.add({});
    for (const Vec3f& point : points) framing.add({&point, 1});
    ASSERT_FALSE(framing.empty());
    const Camera whole = framing_camera(points, view, kAspect);
    EXPECT_EQ(framing.camera().eye, whole.eye);
    EXPECT_EQ(framing.camera().half_height, whole.half_height);
  }
}

TEST(Renderer, DrawsOneIsovalueAfterTheOther) {
  const Volume ball = sphere(24);
  const Camera camera = orbit_camera(ball.lattice(), {}, kAspect);
  const Renderer renderer(ball);
  for (const float isovalue : {-0.4f, -0.2f, -0.3f}) {
    const RenderSettings settings{.width = 30, .height = 20, .isovalue = isovalue};
    EXPECT_EQ(renderer.draw(camera, settings, normal_shader(), {}).pixels,
              render(ball, camera, settings, normal_shader(), {}).pixels);
  }
}

TEST(Camera, OrthographicKeepsSizes) {
  const Volume ball = sphere(32);
  RenderSettings settings{.width = 90, .height = 60, .supersampling = 2, .isovalue = -kBall};
  settings.background.reset();
  const Camera camera = orbit_camera(ball.lattice(), {.projection = Projection::kOrthographic}, kAspect);
  const Image image = render(ball, camera, settings, normal_shader(), {});
  double covered = 0.0;
  for (const float c : image.coverage) covered += double(c);
  // A disc of the ball's radius, in pixels; rays and the grid's ball are within a hundredth.
  const double pixel = 2.0 * camera.half_height / settings.height;
  EXPECT_NEAR(covered * pixel * pixel / (std::numbers::pi * double(kBall * kBall)), 1.0, 0.02);
}

TEST(Render, LeavesTheBackgroundOutWhereItIsTransparent) {
  const Volume ball = sphere(32);
  const Camera camera = orbit_camera(ball.lattice(), {}, kAspect);
  RenderSettings settings{.width = 90, .height = 60, .isovalue = -kBall, .background = Vec3f(0.0f)};
  const Shader white = [](const SurfacePoint&) { return Vec3f(1.0f); };
  const Image opaque = render(ball, camera, settings, white, {});
  EXPECT_TRUE(opaque.coverage.empty());
  settings.background.reset();
  const Image clear = render(ball, camera, settings, white, {});
  ASSERT_EQ(clear.coverage.size(), clear.pixels.size());
  int partly = 0;
  for (std::size_t i = 0; i < clear.pixels.size(); ++i) {
    // White on black is the coverage; the colour itself is white wherever anything is seen.
    EXPECT_FLOAT_EQ(clear.coverage[i], opaque.pixels[i].x);
    EXPECT_EQ(clear.pixels[i], Vec3f(clear.coverage[i] > 0.0f ? 1.0f : 0.0f));
    if (clear.coverage[i] > 0.0f && clear.coverage[i] < 1.0f) ++partly;
  }
  EXPECT_GT(partly, 20);
  EXPECT_EQ(clear.coverage.front(), 0.0f);
  EXPECT_EQ(clear.coverage[clear.offset(45, 30)], 1.0f);
}

}  // namespace
}  // namespace isolux::test
