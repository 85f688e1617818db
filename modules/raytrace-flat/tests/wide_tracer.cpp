// The backend `wide` against exact answers and against `scalar`.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <pthread.h>

#include <functional>

#include "physics_support.h"

namespace isolux::test {
namespace {

TraceResult trace_with(const char* backend, const Volume& volume, const Scene& scene, const Sites& sites,
                       const TraceSettings& settings, int threads = 0) {
  Run run;
  run.threads = threads;
  return tracers().create(backend)->trace(volume, scene, sites, settings, run);
}

Sites box_sites(const Volume& volume, int count, OuterSide outer) {
  return sites_at(volume, random_positions(count, 5, [](const Vec3&) { return true; }), outer);
}

/// The two backends' e over many sites: means within noise of each other, and site by site too.
void expect_same_light(const Volume& volume, const Scene& scene, int rays, int bounces) {
  const Sites sites = box_sites(volume, 300, scene.outer);
  const TraceSettings settings{.rays = rays, .bounces = bounces};
  const SampleSet a = trace_with("scalar", volume, scene, sites, settings).samples;
  const SampleSet b = trace_with("wide", volume, scene, sites, settings).samples;
  ASSERT_EQ(a.radiance.size(), b.radiance.size());
  double mean = 0.0;
  double squares = 0.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < a.radiance.size(); ++i) {
    const double d = double(a.radiance[i]) - double(b.radiance[i]);
    mean += d;
    squares += d * d;
    variance += double(a.variance[i / std::size_t(a.channels)]) + double(b.variance[i / std::size_t(a.channels)]);
  }
  const auto n = double(a.radiance.size());
  // Both are unbiased with the variances that they say: the mean difference is within 4 of its standard errors (the
  // floor is for scenes without noise), and the mean square no larger than 1.5 times what the variances make of it.
  EXPECT_LT(std::abs(mean / n), 4.0 * std::sqrt(variance) / n + 1e-6);
  EXPECT_LT(squares, 1.5 * variance + 1e-9);
}

TEST(WideTracer, AgreesWithScalarUnderASkyWithoutBounces) {
  Scene scene = furnace(0.8f);
  scene.environment = half_sky({0.3f, 0.2f, 1.0f});
  expect_same_light(gyroid(32), scene, 64, 0);
}

TEST(WideTracer, AgreesWithScalarOverAllBounces) {
  Scene scene = furnace(0.8f, OuterSide::kHigher);
  scene.environment = half_sky({0.0f, 0.0f, 1.0f});
  scene.emission = {.keys = {{-1.0f, Vec3f(0.0f)}, {1.0f, Vec3f(0.5f)}}};
  expect_same_light(gyroid(32), scene, 64, kAllBounces);
}

TEST(WideTracer, AgreesWithScalarUnderColouredLamps) {
  Scene scene = darkness(0.5f);
  scene.lights.emplace_back(SunLight{.direction = {1.0f, 2.0f, 3.0f}, .irradiance = {1.0f, 0.5f, 0.2f}});
  scene.lights.emplace_back(SphereLight{.center = {0.5f, 0.5f, 1.2f}, .radius = 0.1f, .radiance = Vec3f(3.0f)});
  scene.lights.emplace_back(RectangleLight{
      .center = {0.4f, 0.5f, 0.6f}, .u = {0.1f, 0.0f, 0.0f}, .v = {0.0f, 0.1f, 0.0f}, .radiance = {0.0f, 0.0f, 2.0f}});
  expect_same_light(gyroid(32), scene, 64, 2);
}

TEST(WideTracer, AgreesWithScalarUnderSunsWithoutBounces) {
  // A wide sun has a penumbra, and sites that face a part of it; the other one is as ours.
  Scene scene = darkness(0.5f);
  scene.lights.emplace_back(
      SunLight{.direction = {1.0f, 2.0f, 3.0f}, .irradiance = {1.0f, 0.5f, 0.2f}, .angular_diameter_deg = 40.0f});
  scene.lights.emplace_back(SunLight{.direction = {-1.0f, 0.0f, 1.0f}, .irradiance = {0.2f, 0.5f, 0.4f}});
  expect_same_light(gyroid(32), scene, 64, 0);
  scene.environment = half_sky({0.3f, 0.2f, 1.0f});
  scene.emission = constant(0.2f);
  expect_same_light(gyroid(32), scene, 64, 0);
  scene.lights.emplace_back(SphereLight{.center = {0.5f, 0.5f, 1.2f}, .radius = 0.1f, .radiance = Vec3f(3.0f)});
  scene.outer = OuterSide::kHigher;
  expect_same_light(gyroid(32), scene, 64, 0);
}

TEST(WideTracer, AsksNothingWhereASunIsBelowTheHorizon) {
  const Volume volume = sphere(32);
  Scene scene = darkness(0.5f);
  scene.lights.emplace_back(SunLight{.direction = {0.0f, 0.0f, 1.0f}});
  const auto sites = [&](double sign) {
    return sites_at(volume, {{0.5, 0.5, 0.5 + 0.3 * sign}, {0.6, 0.5, 0.5 + 0.2 * sign}}, OuterSide::kLower);
  };
  const TraceResult below = trace_with("wide", volume, scene, sites(-1.0), {.rays = 16, .bounces = 0});
  EXPECT_EQ(below.counters.rays, 0u);
  for (const float e : below.samples.radiance) EXPECT_EQ(e, 0.0f);
  const TraceResult above = trace_with("wide", volume, scene, sites(1.0), {.rays = 16, .bounces = 0});
  // Two sites, each twice (see the variances of e).
  EXPECT_EQ(above.counters.rays, 64u);
}

TEST(WideTracer, AgreesWithScalarUnderAnImageOfTheSky) {
  Scene scene = furnace(0.5f);
  ImageEnvironment image{.width = 8, .height = 4, .pixels = std::vector<Vec3f>(32, Vec3f(0.1f))};
  image.pixels[5] = Vec3f(20.0f);
  scene.environment = image;
  expect_same_light(gyroid(32), scene, 64, 1);
  // Without reflections the bright pixel is aimed at apart from the others, beside lamps of either kind.
  expect_same_light(gyroid(32), scene, 64, 0);
  scene.lights.emplace_back(SunLight{.direction = {1.0f, 0.0f, 1.0f}, .irradiance = Vec3f(0.5f)});
  scene.lights.emplace_back(SphereLight{.center = {0.5f, 0.5f, 1.5f}, .radius = 0.3f, .radiance = Vec3f(2.0f)});
  expect_same_light(gyroid(32), scene, 64, 0);
}

TEST(WideTracer, KeepsTheWhiteFurnaceWhite) {
  const Volume volume = sphere(32);
  const Sites sites =
      sites_at(volume, random_positions(200, 2, [](const Vec3& p) { return glm::length(p - kCenter) > 0.05; }),
               OuterSide::kLower);
  const SampleSet samples = trace_with("wide", volume, furnace(1.0f), sites, {.rays = 64}).samples;
  // Every path ends in the environment with its throughput intact, whatever it has met.
  for (const float e : samples.radiance) EXPECT_NEAR(e, 1.0f, 1e-5f);
}

TEST(WideTracer, MatchesTheOpenIntegratingSphere) {
  const Volume volume = cavity(64);
  std::vector<Vec3> positions;
  RandomStream random(3, 4);
  while (positions.size() < 400) {
    const Vec3 p = Vec3(kCenter) + (0.52 + 0.16 * random.uniform_double()) * random_direction(random);
    if (std::min({p.x, p.y, p.z}) >= 0.0 && std::max({p.x, p.y, p.z}) <= 1.0) positions.push_back(p);
  }
  const Sites sites = sites_at(volume, positions, OuterSide::kLower);
  const SampleSet samples = trace_with("wide", volume, furnace(0.8f), sites, {.rays = 256}).samples;
  const ErrorOfE error = error_of(samples, [&](std::size_t i) {
    const double open = 3.0 * (1.0 - 0.5 / double(sites.isovalues[i]));
    return open / (1.0 - 0.8 * (1.0 - open));
  });
  // A path's standard deviation is under .4: 256 of them leave .025 unstratified, and 400 sites .00125 of the mean. The
  // grid's own bias is some .001.
  EXPECT_LT(error.rms, 0.025);
  EXPECT_LT(std::abs(error.bias), 0.004);
}

TEST(WideTracer, GivesTheSameBitsForAnyNumberOfThreads) {
  const Volume volume = gyroid(24);
  Scene scene = furnace(0.8f);
  scene.environment = half_sky({0.0f, 0.0f, 1.0f});
  scene.lights.emplace_back(SunLight{});
  const Sites sites = box_sites(volume, 500, OuterSide::kLower);
  for (const int bounces : {0, kAllBounces}) {
    const SampleSet one = trace_with("wide", volume, scene, sites, {.rays = 16, .bounces = bounces}, 1).samples;
    const SampleSet three = trace_with("wide", volume, scene, sites, {.rays = 16, .bounces = bounces}, 3).samples;
    EXPECT_EQ(one.radiance, three.radiance);
    EXPECT_EQ(one.variance, three.variance);
  }
}

TEST(WideTracer, SaysItsOwnVariance) {
  const Volume volume = two_spheres(48);
  // Sites whose other ball is above the horizon, wholly: e = 1 - cos(a) (r/d)^2 (docs/theory.md).
  const Vec3 balls[2] = {{0.3, 0.5, 0.5}, {0.7, 0.5, 0.5}};
  const auto expected = [&](const Vec3& p, double& cosine, double& ratio) {
    const int own = glm::length(p - balls[0]) < glm::length(p - balls[1]) ? 0 : 1;
    const Vec3 n = glm::normalize(p - balls[own]);
    const Vec3 way = balls[1 - own] - p;
    cosine = glm::dot(n, way) / glm::length(way);
    ratio = glm::length(p - balls[own]) / glm::length(way);
    return 1.0 - cosine * ratio * ratio;
  };
  const Sites sites = sites_at(volume,
                               random_positions(2000, 8,
                                                [&](const Vec3& p) {
                                                  double cosine = 0.0;
                                                  double ratio = 0.0;
                                                  (void)expected(p, cosine, ratio);
                                                  const double radius =
                                                      std::min(glm::length(p - balls[0]), glm::length(p - balls[1]));
                                                  return cosine > ratio + 0.05 && radius > 0.08 && radius < 0.19;
                                                }),
                               OuterSide::kLower);
  const SampleSet samples = trace_with("wide", volume, furnace(0.0f), sites, {.rays = 64, .bounces = 0}).samples;
  double cosine = 0.0;
  double ratio = 0.0;
  const ErrorOfE error = error_of(samples, [&](std::size_t i) {
    return expected(volume.lattice().frame.world(Vec3(sites.positions[i])), cosine, ratio);
  });
  double variance = 0.0;
  for (const float v : samples.variance) variance += double(v);
  const double estimate = std::sqrt(variance / double(samples.size()));
  // The estimate is honest: the true error lies within a factor of 1.3.
  EXPECT_LT(error.rms, 1.3 * estimate);
  EXPECT_GT(error.rms, estimate / 1.3);
}

// All the noise is in a few sites of the penumbra, of which hardly a probe is one.
TEST(WideTracer, SaysTheNoiseOfSmallLamps) {
  const Volume volume = gyroid(24);
  const Sites sites = box_sites(volume, 8000, OuterSide::kLower);
  const auto wide = tracers().create("wide");
  const SphereLight ball{.center = Vec3(2.4, 2.0, 1.6), .radius = 0.04f, .radiance = Vec3f(900.0f)};
  for (const Light& lamp : {Light(SunLight{.direction = {1.0f, -1.0f, 1.0f}}), Light(ball)}) {
    Scene scene = furnace(0.0f);
    scene.environment = UniformEnvironment{Vec3f(0.0f)};
    scene.lights = {lamp};
    const auto light = [&](int rays, std::uint64_t seed) {
      return wide->trace(volume, scene, sites, {.rays = rays, .bounces = 0}, {.seed = seed}).samples;
    };
    const std::vector<float> truth = light(1024, 99).radiance;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const SampleSet samples = light(16, seed);
      double variance = 0.0;
      for (const float v : samples.variance) variance += double(v) / double(samples.size());
      const ErrorOfE error = error_of(samples, [&](std::size_t i) { return double(truth[i]); });
      EXPECT_LT(error.rms, 1.8 * std::sqrt(variance)) << seed;
      EXPECT_GT(error.rms, std::sqrt(variance) / 1.8) << seed;
    }
  }
}

TEST(WideTracer, RefusesSitesWithoutNormals) {
  const Volume volume = gyroid(8);
  Sites sites = box_sites(volume, 3, OuterSide::kLower);
  sites.normals.pop_back();
  EXPECT_THROW((void)trace_with("wide", volume, Scene{}, sites, {}), InvalidInput);
}

// What threads hold from their start lies on their stacks: with more of that than a stack has room for, none starts.
TEST(WideTracer, TracesInThreadsOfSmallStacks) {
  const Volume volume = gyroid(8);
  const Sites sites = box_sites(volume, 100, OuterSide::kLower);
  SampleSet samples;
  std::function<void()> work = [&] {
    samples = trace_with("wide", volume, furnace(0.5f), sites, {.rays = 8}, 1).samples;
  };
  pthread_attr_t small;
  ASSERT_EQ(pthread_attr_init(&small), 0);
  ASSERT_EQ(pthread_attr_setstacksize(&small, std::size_t(512) << 10), 0);
  const auto run = [](void* given) -> void* {
    (*static_cast<std::function<void()>*>(given))();
    return nullptr;
  };
  pthread_t thread{};
  ASSERT_EQ(pthread_create(&thread, &small, run, &work), 0);
  ASSERT_EQ(pthread_join(thread, nullptr), 0);
  pthread_attr_destroy(&small);
  EXPECT_EQ(samples.radiance, trace_with("wide", volume, furnace(0.5f), sites, {.rays = 8}).samples.radiance);
}

}  // namespace
}  // namespace isolux::test
