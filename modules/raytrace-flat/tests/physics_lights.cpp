// Light sources and environments against integrals known in closed form, for every backend.
#include <gtest/gtest.h>

#include <numbers>

#include "physics_support.h"

namespace isolux::test {
namespace {

constexpr double kPi = std::numbers::pi;

class Lights : public EveryTracer {};
ISOLUX_FOR_EVERY_TRACER(Lights);

/// f = -z: level sets are planes that face up; nothing is hidden.
Volume floor_volume() {
  return unit_cube_volume(17, [](const Vec3& p) { return -p.z; });
}

Sites floor_sites(const Volume& volume, int count) {
  return sites_at(volume, random_positions(count, 1, [](const Vec3& p) { return p.z < 0.5; }), OuterSide::kLower);
}

Scene lit_by(const Light& light) {
  Scene scene = darkness(0.5f);
  scene.lights = {light};
  return scene;
}

// Integral of cos / pi over a polygon seen from the origin of a surface of normal n (Lambert 1760), corners in order.
double polygon_e(const std::vector<Vec3>& corners, const Vec3& n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = glm::normalize(corners[i]);
    const Vec3 b = glm::normalize(corners[(i + 1) % corners.size()]);
    const Vec3 across = glm::cross(a, b);
    sum += std::atan2(glm::length(across), glm::dot(a, b)) * glm::dot(n, glm::normalize(across));
  }
  return std::abs(sum) / (2.0 * kPi);
}

TEST_P(Lights, ARectangleGivesLambertsFormula) {
  const Volume volume = floor_volume();
  const Sites sites = floor_sites(volume, 50);
  // Near and in the box, far and small, and slanted and skew.
  for (const RectangleLight& light :
       {RectangleLight{.center = {0.5f, 0.5f, 0.6f}, .u = {0.3f, 0, 0}, .v = {0, -0.2f, 0}, .radiance = Vec3f(1.0f)},
        RectangleLight{.center = {9.0f, 5.0f, 30.0f}, .u = {0.1f, 0, 0}, .v = {0, -0.3f, 0}, .radiance = Vec3f(1e4f)},
        RectangleLight{
            .center = {0.5f, 2.0f, 2.0f}, .u = {0, 0.5f, 0.5f}, .v = {1, 0.1f, 0}, .radiance = Vec3f(4.0f)}}) {
    const SampleSet samples = trace(volume, lit_by(light), sites, 1024, 0).samples;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const Vec3 p = volume.lattice().frame.world(Vec3(sites.positions[i]));
      const Vec3 c = Vec3(light.center) - p;
      const Vec3 u(light.u);
      const Vec3 v(light.v);
      const bool in_front = glm::dot(glm::cross(u, v), -c) > 0.0;
      const double seen = in_front ? polygon_e({c - u - v, c + u - v, c + u + v, c - u + v}, {0, 0, 1}) : 0.0;
      const double expected = double(light.radiance.x) * seen;
      // Smooth integrands on 1024 strata: errors of their spread / 1024, at most a thousandth.
      EXPECT_NEAR(samples.radiance[i], expected, 0.002 * expected + 1e-6);
    }
  }
}

TEST_P(Lights, ARectangleShinesOnOneSideOnly) {
  const Volume volume = floor_volume();
  const RectangleLight light{
      .center = {0.5f, 0.5f, 0.8f}, .u = {0.3f, 0, 0}, .v = {0, 0.2f, 0}, .radiance = Vec3f(1.0f)};
  const SampleSet samples = trace(volume, lit_by(light), floor_sites(volume, 20), 64, 0).samples;
  EXPECT_EQ(error_of(samples, [](std::size_t) { return 0.0; }).worst, 0.0);
}

TEST_P(Lights, ABallGivesItsSolidAngle) {
  const Volume volume = floor_volume();
  const Sites sites = floor_sites(volume, 50);
  for (const SphereLight& light :
       {SphereLight{.center = {0.5f, 0.6f, 0.9f}, .radius = 0.3f, .radiance = Vec3f(1.0f)},
        SphereLight{.center = {40.0f, -9.0f, 60.0f}, .radius = 0.5f, .radiance = Vec3f(1e4f)}}) {
    const SampleSet samples = trace(volume, lit_by(light), sites, 1024, 0).samples;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const Vec3 way = Vec3(light.center) - volume.lattice().frame.world(Vec3(sites.positions[i]));
      const double distance = glm::length(way);
      const double radius(light.radius);
      if (way.z < radius) continue;  // partly below the horizon
      const double expected = double(light.radiance.x) * (way.z / distance) * (radius * radius) / (distance * distance);
      EXPECT_NEAR(samples.radiance[i], expected, 0.002 * expected + 1e-6);  // as for rectangles
    }
  }
}

// Two planes that face each other, f = |z - 1/2|, with a ball light between them and one behind the upper plane.
TEST_P(Lights, WallsHideWhatIsBehindThemAndNotWhatIsBefore) {
  const Volume volume = unit_cube_volume(17, [](const Vec3& p) { return std::abs(p.z - kCenter); });
  const Sites sites = sites_at(volume, {{0.5, 0.5, 0.25}, {0.3, 0.6, 0.25}, {0.7, 0.2, 0.25}}, OuterSide::kLower);
  const SphereLight between{.center = {0.5f, 0.5f, 0.65f}, .radius = 0.05f, .radiance = Vec3f(1.0f)};
  const SphereLight behind{.center = {0.5f, 0.5f, 0.85f}, .radius = 0.05f, .radiance = Vec3f(1.0f)};
  EXPECT_EQ(error_of(trace(volume, lit_by(behind), sites, 64, 0).samples, [](std::size_t) { return 0.0; }).worst, 0.0);
  const SampleSet samples = trace(volume, lit_by(between), sites, 1024, 0).samples;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Vec3 way = Vec3(between.center) - volume.lattice().frame.world(Vec3(sites.positions[i]));
    const double distance = glm::length(way);
    const double expected = way.z / distance * 0.05 * 0.05 / (distance * distance);
    EXPECT_NEAR(samples.radiance[i], expected, 0.002 * expected);
  }
}

/// An image of one value everywhere but for one pixel.
ImageEnvironment image_with_a_lamp(int width, int height, int column, int row, float lamp, float rest) {
  ImageEnvironment image{.width = width, .height = height, .pixels = {}};
  image.pixels.assign(std::size_t(width) * std::size_t(height), Vec3f(rest));
  image.pixels[std::size_t(row) * std::size_t(width) + std::size_t(column)] = Vec3f(lamp);
  return image;
}

TEST_P(Lights, AnEvenImageIsAUniformSky) {
  const Volume volume = floor_volume();
  Scene scene = furnace(0.5f);
  scene.environment = image_with_a_lamp(16, 8, 0, 0, 0.75f, 0.75f);
  const SampleSet samples = trace(volume, scene, floor_sites(volume, 50), 256, 0).samples;
  // Two strategies share the light; their shares vary smoothly: 1/256 times a spread of some tenths.
  EXPECT_LT(error_of(samples, [](std::size_t) { return 0.75; }).worst, 0.01);
}

TEST_P(Lights, ABrightPixelIsFoundAndWeighedRightly) {
  const Volume volume = floor_volume();
  Scene scene = furnace(0.5f);
  const ImageEnvironment image = image_with_a_lamp(64, 32, 10, 6, 5000.0f, 0.25f);
  const Environment environment = image;
  scene.environment = environment;
  // The integral over directions above the floor, by brute force on a fine grid of heights and azimuths.
  double expected = 0.0;
  constexpr int kRows = 512;
  constexpr int kColumns = 1024;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      const double cosine = std::sqrt((r + 0.5) / kRows);  // uniform in cos^2: the weight cos/pi is in the measure
      const double angle = 2.0 * kPi * (c + 0.5) / kColumns;
      const double sine = std::sqrt(1.0 - cosine * cosine);
      expected += double(environment_radiance(environment, {sine * std::cos(angle), sine * std::sin(angle), cosine}).x);
    }
  }
  expected /= double(kRows) * kColumns;
  const SampleSet samples = trace(volume, scene, floor_sites(volume, 40), 256, 0).samples;
  // The lamp is a tent of four patches: its spread is about its mean, e, over 256 strata, and the grid's above is .001.
  EXPECT_LT(error_of(samples, [&](std::size_t) { return expected; }).rms, 0.01 * expected);
  EXPECT_GT(expected, 1.0);
}

TEST_P(Lights, ColoursStayInTheirChannels) {
  const Volume volume = cavity(24);
  Scene scene = darkness(0.5f);
  scene.emission = {.keys = {{0.0f, {1.0f, 0.0f, 0.0f}}, {1.0f, {0.0f, 2.0f, 0.0f}}}};
  scene.albedo = {.keys = {{0.0f, {0.5f, 0.25f, 0.0f}}}};
  const Sites sites = sites_at(volume, {{0.5, 0.5, 0.75}}, OuterSide::kLower);
  const SampleSet samples = trace(volume, scene, sites, 16, 1).samples;
  ASSERT_EQ(samples.channels, 3);
  const auto h = double(sites.isovalues[0]);
  // One emitting hit and one reflection: Le (1 + rho).
  EXPECT_NEAR(samples.radiance[0], (1.0 - h) * 1.5, 1e-6);
  EXPECT_NEAR(samples.radiance[1], 2.0 * h * 1.25, 1e-6);
  EXPECT_EQ(samples.radiance[2], 0.0f);
}

}  // namespace
}  // namespace isolux::test
