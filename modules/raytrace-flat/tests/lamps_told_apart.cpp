// What lamps send straight to a site, told apart from the rest of its light.
#include <gtest/gtest.h>
#include <isolux/raytrace_flat/light_links.h>

#include <vector>

#include "cell_sites.h"
#include "physics_support.h"

namespace isolux::test {
namespace {

constexpr std::uint64_t kSeed = 5;

/// A sun that is a point, so that every site either sees it or not, and some more light.
Scene sunny() {
  Scene scene = furnace(0.5f);
  scene.environment = half_sky({0.0f, 0.0f, 1.0f});
  scene.lights.emplace_back(
      SunLight{.direction = {1.0f, 1.0f, 2.0f}, .irradiance = Vec3f(2.0f), .angular_diameter_deg = 0.0f});
  return scene;
}

Sites gyroid_sites(const Volume& volume) {
  std::vector<std::size_t> texel;
  return cell_sites(volume, OuterSide::kLower, texel);
}

SampleSet traced(const Volume& volume, const Scene& scene, int bounces, LampLight lamps) {
  Run run;
  run.seed = kSeed;
  return tracers()
      .create("wide")
      ->trace(volume, scene, gyroid_sites(volume), {.rays = 16, .bounces = bounces, .lamps = lamps}, run)
      .samples;
}

SampleSet solved(const Volume& volume, const Scene& scene, int bounces, LampLight lamps) {
  Run run;
  run.seed = kSeed;
  const LightLinks links(volume, gyroid_sites(volume), {.rays = 16}, run);
  return links.solve(scene, {.bounces = bounces, .lamps = lamps}, {}, run).samples;
}

/// The sun's light alone, without reflections.
std::vector<float> sunlight(const Volume& volume) {
  Scene scene = sunny();
  scene.environment = UniformEnvironment{.radiance = Vec3f(0.0f)};
  return traced(volume, scene, 0, LampLight::kWithin).radiance;
}

void expect_told_apart(const SampleSet& within, const SampleSet& apart, const std::vector<float>& sun) {
  EXPECT_EQ(within.radiance, apart.radiance);
  EXPECT_EQ(within.variance, apart.variance);
  EXPECT_TRUE(within.lamps.empty());
  ASSERT_EQ(apart.lamps.size(), sun.size());
  ASSERT_EQ(apart.lamps_variance.size(), apart.variance.size());
  for (std::size_t s = 0; s < sun.size(); ++s) {
    // 16 floats added up in one order or another.
    EXPECT_NEAR(apart.lamps[s], sun[s], 1e-5f);
    EXPECT_LE(apart.lamps[s], apart.radiance[s] + 1e-5f);
    // All rays to a point say the same.
    EXPECT_NEAR(apart.lamps_variance[s], 0.0f, 1e-10f);
  }
}

TEST(LampsToldApart, AreSunlightWithoutReflectionsHoweverTraced) {
  const Volume volume = gyroid(17);
  const std::vector<float> sun = sunlight(volume);
  for (const int bounces : {0, 2}) {
    expect_told_apart(traced(volume, sunny(), bounces, LampLight::kWithin),
                      traced(volume, sunny(), bounces, LampLight::kToldApart), sun);
    expect_told_apart(solved(volume, sunny(), bounces, LampLight::kWithin),
                      solved(volume, sunny(), bounces, LampLight::kToldApart), sun);
  }
}

TEST(LampsToldApart, SayWhatTheyDoNotKnowOfARectangle) {
  const Volume volume = gyroid(17);
  Scene scene = sunny();
  scene.lights = {RectangleLight{
      .center = {0.5f, 0.5f, 1.3f}, .u = {0.4f, 0.0f, 0.0f}, .v = {0.0f, -0.4f, 0.0f}, .radiance = Vec3f(3.0f)}};
  for (const int bounces : {0, 2}) {
    const SampleSet samples = traced(volume, scene, bounces, LampLight::kToldApart);
    int noisy = 0;
    for (std::size_t s = 0; s < samples.size(); ++s) noisy += samples.lamps_variance[s] > 1e-6f ? 1 : 0;
    EXPECT_GT(noisy, int(samples.size()) / 10);  // what sees a part of it, or it from close by
  }
}

TEST(LampsToldApart, AreNotThereWithoutLamps) {
  const Volume volume = gyroid(17);
  EXPECT_TRUE(traced(volume, furnace(0.5f), 0, LampLight::kToldApart).lamps.empty());
  EXPECT_TRUE(traced(volume, furnace(0.5f), 2, LampLight::kToldApart).lamps.empty());
}

}  // namespace
}  // namespace isolux::test
