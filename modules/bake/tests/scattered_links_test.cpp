// All bounces of scattered sites, found by iteration on one set of rays.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <cmath>

namespace isolux::test {
namespace {

BakeSettings fitted(int rays, int bounces) {
  BakeSettings settings;
  settings.resampler.name = "fit";
  settings.trace.rays = rays;
  settings.trace.bounces = bounces;
  return settings;
}

BakeSettings by_paths(BakeSettings settings) {
  settings.bounce_method = BounceMethod::kPaths;
  return settings;
}

Scene grey(float albedo, float emission, float sky) {
  Scene scene;
  scene.albedo = {.keys = {{0.0f, Vec3f(albedo)}}};
  scene.emission = {.keys = {{0.0f, Vec3f(emission)}}};
  scene.environment = UniformEnvironment{Vec3f(sky)};
  return scene;
}

BakeResult lit(const Volume& volume, const Scene& scene, const BakeSettings& settings, int threads = 1) {
  isolux::Run run;
  run.threads = threads;
  return bake(volume, scene, settings, builtin_stages(), run);
}

double mean(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float v : values) sum += double(v);
  return sum / double(values.size());
}

TEST(ScatteredLinks, AreTheDefaultOfTheFit) {
  const BakeResult result = lit(read_volume("gen:gyroid:9"), grey(0.8f, 0.0f, 1.0f), fitted(8, kAllBounces));
  EXPECT_GT(result.sweeps, 0);
  EXPECT_GT(result.link_bytes, 0u);
}

// A furnace: surfaces of albedo .5 that shine as half of a white sky do not show. Iteration starts at the light without
// reflections and ends when .002 of e is left to come.
TEST(ScatteredLinks, NothingShowsInAFurnace) {
  const Volume volume = read_volume("gen:gyroid:13");
  const BakeResult result = lit(volume, grey(0.5f, 0.5f, 1.0f), fitted(16, kAllBounces));
  for (const float e : result.light.values) EXPECT_NEAR(e, 1.0f, 0.004f);
}

TEST(ScatteredLinks, BlackSurfacesReflectNothing) {
  const Volume volume = read_volume("gen:gyroid:13");
  const Scene black = grey(0.0f, 0.0f, 1.0f);
  const BakeResult all = lit(volume, black, fitted(16, kAllBounces));
  const BakeResult none = lit(volume, black, fitted(16, 0));
  ASSERT_EQ(all.light.values.size(), none.light.values.size());
  // The same rays: whether they escape is asked in another way, the sums differ by rounding.
  EXPECT_NEAR(mean(all.light.values), mean(none.light.values), 1e-3);
}

TEST(ScatteredLinks, AreTheSameForAnyNumberOfThreads) {
  const Volume volume = read_volume("gen:gyroid:13");
  Scene scene = grey(0.8f, 0.1f, 1.0f);
  scene.albedo = {.keys = {{-1.0f, {0.2f, 0.4f, 0.6f}}, {1.0f, {0.9f, 0.5f, 0.1f}}}};
  const BakeResult one = lit(volume, scene, fitted(8, kAllBounces), 1);
  const BakeResult three = lit(volume, scene, fitted(8, kAllBounces), 3);
  EXPECT_EQ(one.light.channels, 3);
  EXPECT_EQ(one.light.values, three.light.values);
  EXPECT_EQ(one.light.detail.slopes, three.light.detail.slopes);
}

// Reflected light read from texels is biased by their size: 2 % of e here, where noise of the mean is .1 %.
TEST(ScatteredLinks, AgreeWithPaths) {
  const Volume volume = read_volume("gen:gyroid:25");
  Scene scene = grey(0.8f, 0.0f, 1.0f);
  scene.environment = SkyEnvironment{.ground = Vec3f(0.0f)};
  const double iterated = mean(lit(volume, scene, fitted(16, kAllBounces)).light.values);
  const BakeResult paths = lit(volume, scene, by_paths(fitted(16, kAllBounces)));
  EXPECT_EQ(paths.sweeps, 0);
  EXPECT_NEAR(iterated, mean(paths.light.values), 0.02);
}

TEST(ScatteredLinks, LightBothSidesAndKnownIsovalues) {
  const Volume volume = read_volume("gen:gyroid:13");
  Scene scene = grey(0.8f, 0.0f, 1.0f);
  scene.sides = LitSides::kBoth;
  BakeSettings settings = fitted(8, kAllBounces);
  settings.isovalues = ValueRange{-0.2f, 0.2f};
  const BakeResult result = lit(volume, scene, settings);
  EXPECT_GT(result.sweeps, 1);
  ASSERT_TRUE(result.inner_light);
  // The gyroid's sides are alike: their light differs by noise and by where its block is cut.
  EXPECT_NEAR(mean(result.light.values), mean(result.inner_light->values), 0.1 * mean(result.light.values));
}

TEST(ScatteredLinks, AreNotForSitesByNeed) {
  const Volume volume = read_volume("gen:gyroid:9");
  BakeSettings settings = fitted(8, kAllBounces);
  settings.texel_sites = TexelSites::kNeeded;
  EXPECT_EQ(lit(volume, grey(0.8f, 0.0f, 1.0f), settings).sweeps, 0);
  settings.bounce_method = BounceMethod::kIterated;
  EXPECT_THROW((void)lit(volume, grey(0.8f, 0.0f, 1.0f), settings), InvalidInput);
}

}  // namespace
}  // namespace isolux::test
