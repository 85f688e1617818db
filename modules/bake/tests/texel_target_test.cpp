// Errors asked of texels that are made of several sites each.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/volume_io/read.h>

#include <cmath>

#include "texel_target.h"

namespace isolux::test {
namespace {

constexpr double kTarget = 0.01;
constexpr double kSquared = kTarget * kTarget;

/// Texels that keep this part of their sites' noise, and what stays.
HeldOut::SquaredError texels(double sites, double part, double stays) { return {.mean = part * sites + stays}; }

TEST(TexelTarget, EndsWhereTexelsAreRightThoughTheirSitesAreNoisy) {
  TexelTarget target(kTarget);
  target.add(9.0 * kSquared, texels(9.0 * kSquared, 0.1, 0.0));
  EXPECT_TRUE(target.is_reached());
  EXPECT_EQ(target.wanted_noise(), 0.0);
  EXPECT_FALSE(target.is_beyond_rays());
}

TEST(TexelTarget, WantsTheNoiseThatLeavesTheErrorAsked) {
  TexelTarget target(kTarget);
  target.add(64.0 * kSquared, texels(64.0 * kSquared, 0.25, 0.5 * kSquared));
  EXPECT_NEAR(target.wanted_noise(), 8.0 * kSquared, 1e-9);  // all may be noise, but no more than that at once
  target.add(16.0 * kSquared, texels(16.0 * kSquared, 0.25, 0.5 * kSquared));
  EXPECT_GT(target.wanted_noise(), 2.0 * kSquared);
  EXPECT_LT(target.wanted_noise(), 4.0 * kSquared);
  target.add(1.9 * kSquared, texels(1.9 * kSquared, 0.25, 0.5 * kSquared));
  EXPECT_TRUE(target.is_reached());
}

TEST(TexelTarget, GivesUpWhereWhatStaysIsMoreThanRaysCanTakeAway) {
  TexelTarget target(kTarget);
  target.add(16.0 * kSquared, texels(16.0 * kSquared, 0.1, 9.0 * kSquared));
  EXPECT_GT(target.wanted_noise(), 0.0);
  EXPECT_FALSE(target.is_beyond_rays());
  target.add(8.0 * kSquared, texels(8.0 * kSquared, 0.1, 9.0 * kSquared));
  EXPECT_EQ(target.wanted_noise(), 0.0);
  EXPECT_TRUE(target.is_beyond_rays());
}

// Squared errors of denoised texels fall as the square root of their sites' squared noise.
TEST(TexelTarget, GoesOnWhereLessNoiseIsAveragedLess) {
  TexelTarget target(kTarget);
  target.add(36.0 * kSquared, {.mean = 6.0 * kSquared});
  target.add(9.0 * kSquared, {.mean = 3.0 * kSquared});
  EXPECT_NEAR(target.wanted_noise(), 1.125 * kSquared, 1e-9);  // an eighth at most, though a ninth would do
}

TEST(TexelTarget, DoesNotBelieveAnErrorThatMayBeLuck) {
  TexelTarget target(kTarget);
  target.add(9.0 * kSquared, {.mean = 0.9 * kSquared, .standard_error = 0.3 * kSquared});
  EXPECT_FALSE(target.is_reached());
  EXPECT_GT(target.wanted_noise(), 0.0);
}

// What a fit is wrong by between its sites no ray takes away: it went on until the noise of the sites was as small as
// the error asked.
TEST(TexelTarget, SpendsNoRaysOnWhatAFitIsWrongByWithoutNoise) {
  const Volume volume = read_volume("gen:gyroid:12");
  BakeSettings settings;
  settings.resampler.name = "fit";
  settings.trace.bounces = 0;
  settings.target_rmse = 0.02;
  Scene lit;
  lit.lights.emplace_back(SunLight{});
  for (const Scene& scene : {Scene{}, lit}) {
    const BakeResult result = bake(volume, scene, settings, builtin_stages(), {});
    EXPECT_EQ(result.skipped.count("error_beyond_rays"), 1u);
    EXPECT_GT(result.rmse_estimate, 0.01);
    EXPECT_GT(result.noise, 0.006);  // it was .0048
    BakeSettings more = settings;
    more.target_rmse = 0.0;
    more.trace.rays = int(result.most_rays) * 8;
    const BakeResult many = bake(volume, scene, more, builtin_stages(), {});
    EXPECT_GT(many.rmse_estimate, 0.8 * result.rmse_estimate);
  }
}

TEST(TexelTarget, IsReachedByTexelsOfNoisierSites) {
  const Volume volume = read_volume("gen:sphere:16");
  BakeSettings settings;
  settings.trace.bounces = 0;
  settings.samples = 40000;  // ten a cell
  settings.target_rmse = 0.02;
  Scene scene;
  scene.lights.emplace_back(SphereLight{.center = Vec3(0.0, 0.0, 3.0), .radius = 0.5f, .radiance = Vec3f(20.0f)});
  const BakeResult result = bake(volume, scene, settings, builtin_stages(), {});
  EXPECT_LE(result.rmse_estimate, 0.02);
  EXPECT_GT(result.noise, 0.0);
  EXPECT_EQ(result.skipped.count("error_beyond_rays"), 0u);
}

}  // namespace
}  // namespace isolux::test
