// What shaders are told of a point, and what they make of it.
#include <gtest/gtest.h>
#include <isolux/render/render.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "analytic_volume.h"

namespace isolux::test {
namespace {

void expect_colour(const Vec3f& colour, const Vec3f& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(colour[c], expected[c], 1e-6f) << c;
}

/// Seen from (0, 3, 4)/5.
SurfacePoint facing(const Vec3& normal, bool outside = true) {
  return {.normal = normal, .towards_eye = Vec3(0.0, 0.6, 0.8), .outside = outside};
}

TEST(Shading, OfNormalsIsTheirCoordinates) {
  expect_colour(normal_shader()(facing({0.6, 0.0, -0.8})), {0.8f, 0.5f, 0.1f});
}

// 0.7 of a headlight and 0.15 of a sky, of which a normal at h to its middle sees (1 + cos h)/2.
TEST(Shading, LocallyIsAHeadlightAndASky) {
  const Shader shader = local_shader({1.0f, 0.5f, 0.25f});
  const auto expect_light = [&](const SurfacePoint& point, double light) {
    expect_colour(shader(point), float(light) * Vec3f(1.0f, 0.5f, 0.25f));
  };
  expect_light(facing({0.0, 0.6, 0.8}), 0.7 + 0.15 * 1.8);
  expect_light(facing({0.0, 0.0, 1.0}), 0.7 * 0.8 + 0.3);
  expect_light(facing({1.0, 0.0, 0.0}), 0.15);
  expect_light(facing({0.0, 0.0, -1.0}), 0.0);
  expect_light(facing({0.0, -0.8, 0.6}), 0.15 * 1.6);
  expect_light(facing({0.0, 0.0, -1.0}, false), 0.7 * 0.8 + 0.3);
}

TEST(Shading, GloballyIsWhatTheColourMakesOfTheLight) {
  const SurfaceColour colour{.albedo = {0.5f, 0.25f, 1.0f}, .emission = {0.0f, 0.125f, 2.0f}};
  const auto of_place = [](float factor) {
    return [factor](const SurfacePoint& point) { return factor * Vec3f(point.index); };
  };
  SurfacePoint point = facing({0.0, 0.0, 1.0});
  point.index = {1.0, 2.0, 3.0};
  const Vec3f outer(0.5f, 0.625f, 5.0f);
  const Vec3f inner(1.0f, 1.125f, 8.0f);
  const Vec3f dim = 0.1f * 0.3f * colour.albedo;  // a tenth of the local shade
  expect_colour(global_shader(of_place(1.0f), colour)(point), outer);
  expect_colour(global_shader(of_place(1.0f), of_place(2.0f), colour)(point), outer);
  point.outside = false;
  point.towards_eye = {1.0, 0.0, 0.0};
  point.normal = {0.0, 0.0, -1.0};
  expect_colour(global_shader(of_place(1.0f), colour)(point), dim);
  expect_colour(global_shader(of_place(1.0f), of_place(2.0f), colour)(point), inner);
  point.cap = 0;
  expect_colour(global_shader(of_place(1.0f), of_place(2.0f), colour)(point), dim);
}

// In a frame whose axes are oblique and of several lengths, and from a camera that is none of its axes.
TEST(Shading, IsToldWhereItIsAndWhoLooks) {
  Volume volume = sphere(24);
  Lattice lattice = volume.lattice();
  lattice.frame = {.origin = {12.5, -340.0, 7.25}, .axes = Mat3({0.8, 0.6, 0.0}, {-1.2, 1.6, 0.0}, {0.3, 0.2, 5.0})};
  Grid<float> values(lattice);
  std::copy(volume.values.values().begin(), volume.values.values().end(), values.values().begin());
  volume.values = std::move(values);
  const Camera camera = orbit_camera(lattice, 35.0, 25.0, 1.0);
  std::vector<SurfacePoint> seen;
  const Shader keep = [&](const SurfacePoint& point) {
    seen.push_back(point);
    return Vec3f(0.0f);
  };
  const RenderSettings settings{.width = 48, .height = 48, .supersampling = 1, .isovalue = -0.3f};
  static_cast<void>(render(volume, camera, settings, keep, {.threads = 1}));
  ASSERT_GT(seen.size(), 50u);
  const TrilinearField field(volume);
  for (const SurfacePoint& point : seen) {
    EXPECT_NEAR(field.value(point.index), -0.3, 1e-5);
    EXPECT_LT(glm::distance(point.world, lattice.frame.world(point.index)), 1e-9);
    EXPECT_LT(glm::distance(point.towards_eye, glm::normalize(camera.eye - point.world)), 1e-9);
    EXPECT_NEAR(glm::length(point.normal), 1.0, 1e-6);
    EXPECT_GT(glm::dot(point.normal, point.towards_eye), -0.1);  // at the rim the normal is not quite the surface's
  }
}

}  // namespace
}  // namespace isolux::test
