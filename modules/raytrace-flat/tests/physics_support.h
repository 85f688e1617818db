// What the physics tests share: sites on chosen level sets, and the tracer under test.
#pragma once

#include <gtest/gtest.h>
#include <isolux/core/field.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analytic_volume.h"
#include "stress.h"

namespace isolux::test {

/// Sites at world positions; those without a normal are left out.
[[nodiscard]] inline Sites sites_at(const Volume& volume, const std::vector<Vec3>& world, OuterSide outer,
                                    GradientKind gradient = GradientKind::kCentralDifferences) {
  const TrilinearField field(volume);
  Sites sites;
  for (const Vec3& p : world) {
    const Vec3f index(volume.lattice().frame.index(p));
    const Vec3 normal = field.normal(Vec3(index), outer, gradient);
    if (normal == Vec3(0.0)) continue;
    sites.positions.push_back(index);
    sites.isovalues.push_back(float(field.value(Vec3(index))));
    sites.normals.emplace_back(normal);
  }
  return sites;
}

/// `count` positions uniform in the unit cube for which `wanted` holds.
[[nodiscard]] inline std::vector<Vec3> random_positions(int count, std::uint64_t seed,
                                                        const std::function<bool(const Vec3&)>& wanted) {
  RandomStream random(seed, 17);
  std::vector<Vec3> positions;
  while (int(positions.size()) < count) {
    const Vec3 p(random.uniform_double(), random.uniform_double(), random.uniform_double());
    if (wanted(p)) positions.push_back(p);
  }
  return positions;
}

[[nodiscard]] inline Vec3 random_direction(RandomStream& random) {
  const double z = 2.0 * random.uniform_double() - 1.0;
  const double angle = 2.0 * std::numbers::pi * random.uniform_double();
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

[[nodiscard]] inline IsovalueColour constant(float value) { return {.keys = {{0.0f, Vec3f(value)}}}; }

[[nodiscard]] inline Scene furnace(float albedo, OuterSide outer = OuterSide::kLower) {
  Scene scene;
  scene.albedo = constant(albedo);
  scene.outer = outer;
  return scene;
}

/// Uniform environment and no light: only lamps and emission shine.
[[nodiscard]] inline Scene darkness(float albedo, OuterSide outer = OuterSide::kLower) {
  Scene scene = furnace(albedo, outer);
  scene.environment = UniformEnvironment{Vec3f(0.0f)};
  return scene;
}

[[nodiscard]] inline SkyEnvironment half_sky(const Vec3f& up) {
  return {.up = up, .zenith = Vec3f(1.0f), .horizon = Vec3f(1.0f), .ground = Vec3f(0.0f)};
}

/// A physics test runs for every backend of the catalogue, by name.
class EveryTracer : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static TraceResult trace(const Volume& volume, const Scene& scene, Sites sites, int rays, int bounces,
                                         const Settings& settings = {}, std::uint64_t seed = 1) {
    isolux::Run run;
    run.seed = seed;
    return tracers()
        .create(GetParam(), settings)
        ->trace(volume, scene, std::move(sites), {.rays = rays, .bounces = bounces}, run);
  }
};

[[nodiscard]] inline std::vector<std::string> tracer_names() {
  std::vector<std::string> names;
  const auto registry = tracers();
  for (const BackendInfo& info : registry.backends())
    if (info.unavailable.empty()) names.push_back(info.name);
  return names;
}

#define ISOLUX_FOR_EVERY_TRACER(suite)                                        \
  INSTANTIATE_TEST_SUITE_P(Tracers, suite, testing::ValuesIn(tracer_names()), \
                           [](const auto& name) { return name.param; })

/// e - expected(site): root of the mean square, mean, and largest magnitude.
struct ErrorOfE {
  double rms = 0.0;
  double bias = 0.0;
  double worst = 0.0;
};
[[nodiscard]] inline ErrorOfE error_of(const SampleSet& samples, const std::function<double(std::size_t)>& expected) {
  ErrorOfE error;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double d = double(samples.radiance[i * std::size_t(samples.channels)]) - expected(i);
    error.rms += d * d;
    error.bias += d;
    error.worst = std::max(error.worst, std::abs(d));
  }
  error.rms = std::sqrt(error.rms / double(samples.size()));
  error.bias /= double(samples.size());
  return error;
}

}  // namespace isolux::test
