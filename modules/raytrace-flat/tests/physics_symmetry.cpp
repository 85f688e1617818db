// Reciprocity, linearity and invariance (docs/theory.md), for every backend.
#include <gtest/gtest.h>
#include <isolux/raytrace_flat/level_set_intersector.h>

#include "physics_support.h"

namespace isolux::test {
namespace {

class Symmetry : public EveryTracer {};
ISOLUX_FOR_EVERY_TRACER(Symmetry);

std::vector<Vec3> anywhere(int count, std::uint64_t seed) {
  return random_positions(count, seed, [](const Vec3&) { return true; });
}

Scene coloured_sky() {
  Scene scene = furnace(0.5f);
  scene.environment =
      SkyEnvironment{.up = {0.2f, -0.5f, 0.8f}, .zenith = Vec3f(0.5f), .horizon = Vec3f(2.0f), .ground = Vec3f(0.25f)};
  return scene;
}

/// The scene with all its radiances multiplied.
SkyEnvironment sky_part(const SkyEnvironment& sky, float zenith, float horizon, float ground) {
  return {.up = sky.up, .zenith = zenith * sky.zenith, .horizon = horizon * sky.horizon, .ground = ground * sky.ground};
}

TEST(Reciprocity, WhatSeesIsSeen) {
  for (const Volume& volume : {gyroid(32), noise(Index3(16, 20, 12), 21)}) {
    const LevelSetIntersector intersector(volume);
    const TrilinearField field(volume);
    RandomStream random(31, 1);
    const Vec3 last(volume.lattice().size - 1);
    int seen = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Vec3 from(Vec3f(last * Vec3(random.uniform_double(), random.uniform_double(), random.uniform_double())));
      const auto isovalue = float(field.value(from));
      const Vec3 way = random_direction(random);
      const auto there = intersector.next_hit(from, way, isovalue, OuterSide::kLower);
      if (!there || there->t == 0.0) continue;
      // Grazing rays are lost in rounding: both ends must be left at more than a 1e-4 of the steepest way.
      const Vec3 leaving = field.cell_gradient(from + 1e-7 * way);
      const Vec3 arriving = field.cell_gradient(there->position - 1e-7 * way);
      if (-glm::dot(leaving, way) < 1e-4 * glm::length(leaving)) continue;
      if (glm::dot(arriving, way) < 1e-4 * glm::length(arriving)) continue;
      const auto back = intersector.next_hit(there->position, from - there->position, isovalue, OuterSide::kLower);
      ASSERT_TRUE(back) << i;
      ASSERT_NEAR(back->t, 1.0, 1e-6) << i;
      ++seen;
    }
    EXPECT_GT(seen, 1000);
  }
}

TEST_P(Symmetry, LightAddsUp) {
  const Volume volume = gyroid(24);
  const Sites sites = sites_at(volume, anywhere(100, 1), OuterSide::kLower);
  Scene scene = coloured_sky();
  const SkyEnvironment sky = std::get<SkyEnvironment>(scene.environment);
  const SampleSet all = trace(volume, scene, sites, 32, kAllBounces).samples;
  std::vector<double> sum(sites.size(), 0.0);
  for (const SkyEnvironment& part : {sky_part(sky, 1, 0, 0), sky_part(sky, 0, 1, 0), sky_part(sky, 0, 0, 1)}) {
    scene.environment = part;
    const SampleSet one = trace(volume, scene, sites, 32, kAllBounces).samples;
    for (std::size_t i = 0; i < sites.size(); ++i) sum[i] += double(one.radiance[i]);
  }
  // The paths do not depend on the light they meet, so the sums differ by the rounding of floats only.
  EXPECT_LT(error_of(all, [&](std::size_t i) { return sum[i]; }).worst, 1e-5);

  scene.environment = sky_part(sky, 4, 4, 4);
  const SampleSet brighter = trace(volume, scene, sites, 32, kAllBounces).samples;
  EXPECT_LT(error_of(brighter, [&](std::size_t i) { return 4.0 * double(all.radiance[i]); }).worst, 1e-5);
}

TEST_P(Symmetry, EmissionAndLampsAddToTheSky) {
  const Volume volume = gyroid(24);
  const Sites sites = sites_at(volume, anywhere(150, 2), OuterSide::kLower);
  Scene all = coloured_sky();
  all.emission = constant(0.5f);
  all.lights = {SunLight{.direction = {1.0f, 2.0f, 2.0f}},
                SphereLight{.center = {0.4f, 0.5f, 1.5f}, .radius = 0.2f, .radiance = Vec3f(10.0f)}};
  Scene sky = coloured_sky();
  Scene glow = darkness(0.5f);
  glow.emission = all.emission;
  Scene sun = darkness(0.5f);
  sun.lights = {all.lights[0]};
  Scene ball = darkness(0.5f);
  ball.lights = {all.lights[1]};
  std::vector<double> sum(sites.size(), 0.0);
  for (const Scene& scene : {sky, glow, sun, ball}) {
    const SampleSet one = trace(volume, scene, sites, 256, kAllBounces).samples;
    for (std::size_t i = 0; i < sites.size(); ++i) sum[i] += double(one.radiance[i]);
  }
  const SampleSet whole = trace(volume, all, sites, 256, kAllBounces).samples;
  const ErrorOfE error = error_of(whole, [&](std::size_t i) { return sum[i]; });
  double variance = 0.0;
  for (const float v : whole.variance) variance += double(v) / double(sites.size());
  // Independent estimates: each side has the variance that the tracer states, which stratification stays below.
  EXPECT_LT(error.rms, 1.5 * std::sqrt(2.0 * variance));
  EXPECT_LT(std::abs(error.bias), 4.0 * std::sqrt(2.0 * variance / double(sites.size())));
}

/// Lights the image of `field` under a permutation and mirroring of the axes, with the sky turned along.
class TurnedGyroid {
 public:
  TurnedGyroid(const Index3& axes, const Vec3& signs) {
    for (int a = 0; a < 3; ++a) turn_[a][axes[a]] = signs[a];
  }
  /// Turned about the center of the unit cube.
  [[nodiscard]] Vec3 turn(const Vec3& p) const { return turn_ * (p - kCenter) + kCenter; }
  [[nodiscard]] Vec3f turn_direction(const Vec3f& d) const { return Vec3f(turn_ * Vec3(d)); }
  [[nodiscard]] Volume volume() const {
    const Volume straight = gyroid(33);
    const TrilinearField field(straight);
    const Mat3 back = glm::transpose(turn_);
    return unit_cube_volume(33, [&](const Vec3& p) {
      return field.value(glm::round(straight.lattice().frame.index(back * (p - kCenter) + kCenter)));
    });
  }

 private:
  Mat3 turn_{0.0};
};

TEST_P(Symmetry, TurningAndMirroringTheAxesChangesNothing) {
  const auto positions = anywhere(200, 3);
  const Volume straight = gyroid(33);
  const SampleSet expected =
      trace(straight, coloured_sky(), sites_at(straight, positions, OuterSide::kLower), 256, kAllBounces).samples;
  for (const auto& [axes, signs] :
       {std::pair(Index3(1, 2, 0), Vec3(1, 1, 1)), std::pair(Index3(0, 1, 2), Vec3(-1, 1, 1)),
        std::pair(Index3(2, 1, 0), Vec3(-1, -1, 1))}) {
    const TurnedGyroid turned(axes, signs);
    const Volume volume = turned.volume();
    std::vector<Vec3> places;
    places.reserve(positions.size());
    for (const Vec3& p : positions) places.push_back(turned.turn(p));
    Scene scene = coloured_sky();
    auto& sky = std::get<SkyEnvironment>(scene.environment);
    sky.up = turned.turn_direction(sky.up);
    const SampleSet found = trace(volume, scene, sites_at(volume, places, OuterSide::kLower), 256, kAllBounces).samples;
    ASSERT_EQ(found.size(), expected.size());
    double variance = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i)
      variance += double(found.variance[i] + expected.variance[i]) / double(found.size());
    const ErrorOfE error = error_of(found, [&](std::size_t i) { return double(expected.radiance[i]); });
    // The frames about the normals turn otherwise than the axes, so the rays are others: equal up to their noise.
    EXPECT_LT(error.rms, 1.5 * std::sqrt(variance));
    EXPECT_LT(std::abs(error.bias), 4.0 * std::sqrt(variance / double(found.size())));
  }
}

TEST_P(Symmetry, ValuesMayBeScaledShiftedAndTurnedOver) {
  const Volume volume = gyroid(24);
  const auto positions = anywhere(200, 4);
  const SampleSet expected =
      trace(volume, coloured_sky(), sites_at(volume, positions, OuterSide::kLower), 64, kAllBounces).samples;
  const auto light_of = [&](double a, double b) {
    Volume other = volume;
    for (float& v : other.values.values()) v = float(a * double(v) + b);
    Scene scene = coloured_sky();
    scene.outer = a > 0.0 ? OuterSide::kLower : OuterSide::kHigher;
    return trace(other, scene, sites_at(other, positions, scene.outer), 64, kAllBounces).samples;
  };
  // Powers of two and signs change no rounding: the same bits.
  for (const double a : {1024.0, 0x1p-60, -1.0, -0x1p40}) EXPECT_EQ(light_of(a, 0.0).radiance, expected.radiance) << a;
  // Others move the surface by a float's rounding: the same rays, but for some that graze.
  for (const auto& [a, b] : {std::pair(3.0, 1.0), std::pair(-0.7, 100.0)}) {
    const ErrorOfE error = error_of(light_of(a, b), [&](std::size_t i) { return double(expected.radiance[i]); });
    EXPECT_LT(error.rms, 0.01) << a << ", " << b;
    EXPECT_LT(std::abs(error.bias), 0.001) << a << ", " << b;
  }
}

TEST_P(Symmetry, SpacingAndOriginOfTheWorldDoNotMatter) {
  const Volume volume = gyroid(24);
  const auto positions = anywhere(100, 5);
  const Sites sites = sites_at(volume, positions, OuterSide::kLower);
  const SampleSet expected = trace(volume, coloured_sky(), sites, 64, kAllBounces).samples;
  for (const double scale : {0x1p20, 0x1p-20}) {
    Volume other = volume;
    Lattice lattice = volume.lattice();
    lattice.frame.axes *= scale;
    lattice.frame.origin = Vec3(1e6, -1e6, 1e6);
    other.values = Grid<float>(lattice, {volume.values.values().begin(), volume.values.values().end()});
    // Sites and directions do not see the origin; a power of two only scales the directions' lengths.
    EXPECT_EQ(trace(other, coloured_sky(), sites, 64, kAllBounces).samples.radiance, expected.radiance);
  }
}

TEST_P(Symmetry, LampsMoveWithTheWorld) {
  const Volume volume = gyroid(24);
  const Sites sites = sites_at(volume, anywhere(200, 7), OuterSide::kLower);
  const auto light_at = [&](const Vec3& offset) {
    Volume moved = volume;
    Lattice lattice = volume.lattice();
    lattice.frame.origin += offset;
    moved.values = Grid<float>(lattice, {volume.values.values().begin(), volume.values.values().end()});
    Scene scene = darkness(0.5f);
    scene.lights = {
        SphereLight{.center = Vec3(0.4, 0.5, 1.5) + offset, .radius = 0.2f, .radiance = Vec3f(10.0f)},
        RectangleLight{
            .center = Vec3(0.3, 0.6, 0.7) + offset, .u = {0.2f, 0, 0}, .v = {0, -0.2f, 0}, .radiance = Vec3f(2.0f)}};
    return trace(moved, scene, sites, 64, kAllBounces).samples;
  };
  const SampleSet expected = light_at(Vec3(0.0));
  for (const double far : {1e4, 1e8}) {
    const ErrorOfE error =
        error_of(light_at(Vec3(far, -far, 0.5 * far)), [&](std::size_t i) { return double(expected.radiance[i]); });
    // Doubles resolve the places to 1.5e-8 at most: the same rays, but for some that graze.
    EXPECT_LT(error.rms, 0.003) << far;
    EXPECT_LT(std::abs(error.bias), 0.0005) << far;
  }
}

// The open integrating sphere on a grid of spacing 1:1:20 in a world turned by a direction matrix, 1e6 from its origin.
TEST_P(Symmetry, FlatCellsFarFromTheOriginLightAsCubesDo) {
  const Index3 size(81, 81, 5);
  const Mat3 turn(Vec3(0.6, 0.8, 0.0), Vec3(-0.8, 0.6, 0.0), Vec3(0.0, 0.0, 1.0));
  Lattice lattice{.size = size, .frame = {.origin = Vec3(1e6, -2e6, 3e6), .axes = turn * 0.0125}};
  lattice.frame.axes[2] *= 20.0;
  // f = |x - 1/2| in the turned frame: two planes, exact on this grid.
  const Mat3 back = glm::transpose(turn);
  const Volume volume = sampled(lattice, [&](const Vec3& p) {
    return std::round(80.0 * std::abs((back * (p - lattice.frame.origin)).x - 0.5)) / 80.0;
  });
  std::vector<Vec3> positions;
  for (const Vec3& p : anywhere(60, 6))
    if (std::abs(p.x - 0.5) > 0.1) positions.push_back(lattice.frame.origin + turn * p);
  const SampleSet flat =
      trace(volume, furnace(0.5f), sites_at(volume, positions, OuterSide::kLower), 1024, kAllBounces).samples;
  const Volume cube = unit_cube_volume(33, [](const Vec3& p) { return std::abs(p.x - 0.5); });
  std::vector<Vec3> places;
  places.reserve(positions.size());
  for (const Vec3& p : positions) places.push_back(back * (p - lattice.frame.origin));
  const SampleSet expected =
      trace(cube, furnace(0.5f), sites_at(cube, places, OuterSide::kLower), 1024, kAllBounces).samples;
  ASSERT_EQ(flat.size(), expected.size());
  // Two estimates of noise .006 each (the rectangle's edge, then one bounce of half the light).
  EXPECT_LT(error_of(flat, [&](std::size_t i) { return double(expected.radiance[i]); }).rms, 0.01);
}

}  // namespace
}  // namespace isolux::test
