// Errors asked of texels that are made of several sites each.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

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
  target.add(64.0 * kSquared, texels(64.0 * kSquared, 0.1, 9.0 * kSquared));
  EXPECT_GT(target.wanted_noise(), 0.0);
  EXPECT_FALSE(target.is_beyond_rays());
  target.add(8.0 * kSquared, texels(8.0 * kSquared, 0.1, 9.0 * kSquared));
  EXPECT_EQ(target.wanted_noise(), 0.0);
  EXPECT_TRUE(target.is_beyond_rays());
  TexelTarget at_once(kTarget);  // sites so right do not make texels so wrong
  at_once.add(2.0 * kSquared, texels(2.0 * kSquared, 0.5, 9.0 * kSquared));
  EXPECT_TRUE(at_once.is_beyond_rays());
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
  EXPECT_NEAR(target.wanted_noise(), 8.1 * kSquared, 1e-9);
}

// Paths that judge are noisy too: below that the sites' own noise is as small as asked, and it is not said that rays
// would not help.
TEST(TexelTarget, EndsByTheSitesNoiseWhereItsJudgesTellNoSmallerError) {
  TexelTarget target(kTarget);
  for (const double sites : {64.0, 16.0, 4.0}) {
    target.add(sites * kSquared, {.mean = 0.2 * kSquared, .standard_error = 2.0 * kSquared});
    EXPECT_FALSE(target.is_reached());
    EXPECT_NEAR(target.wanted_noise(), std::max(1.0, sites / 8.0) * kSquared, 1e-9);
  }
  target.add(0.9 * kSquared, {.mean = 0.2 * kSquared, .standard_error = 2.0 * kSquared});
  EXPECT_TRUE(target.is_reached());
  EXPECT_FALSE(target.is_beyond_rays());
  TexelTarget missed(kTarget);
  missed.add(0.9 * kSquared, {.mean = 6.0 * kSquared, .standard_error = 2.0 * kSquared});
  EXPECT_FALSE(missed.is_reached());
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
    EXPECT_GT(result.rmse_estimate, 0.1);
    EXPECT_GT(result.noise, 0.022);  // it was below .02
    BakeSettings more = settings;
    more.target_rmse = 0.0;
    more.trace.rays = int(result.most_rays) * 8;
    const BakeResult many = bake(volume, scene, more, builtin_stages(), {});
    EXPECT_GT(many.rmse_estimate, 0.8 * result.rmse_estimate);
  }
}

// Noise averages out over the sites of a texel.
TEST(TexelTarget, IsReachedByTexelsOfNoisierSites) {
  const Volume volume = read_volume("gen:gyroid:48");
  Scene lit;
  lit.lights.emplace_back(SunLight{});
  Scene both;
  both.sides = LitSides::kBoth;
  for (const Scene& scene : {lit, both}) {
    BakeSettings settings;
    settings.trace.bounces = 0;
    settings.resampler.settings = {{"denoise", "true"}};
    settings.target_rmse = 0.02;
    const BakeResult result = bake(volume, scene, settings, builtin_stages(), {});
    EXPECT_LE(result.rmse_estimate, 0.02);
    EXPECT_GT(result.noise, 0.025);
    EXPECT_EQ(result.skipped.count("error_beyond_rays"), 0u);
  }
}

TEST(TexelTarget, IsJudgedWhereATimeOrMemoryEndsItsRounds) {
  const Volume volume = read_volume("gen:gyroid:24");
  BakeSettings settings;
  settings.resampler.name = "fit";
  settings.target_rmse = 1e-5;
  settings.target_seconds = 1e-4;
  const BakeResult hurried = bake(volume, {}, settings, builtin_stages(), {});
  EXPECT_EQ(hurried.most_rays, 4u);
  EXPECT_GT(hurried.rmse_estimate, 0.02);
  settings.target_seconds = 0.0;
  settings.target_rmse = 0.015;
  settings.bounce_method = BounceMethod::kIterated;
  settings.most_link_bytes = std::uint64_t(4) * 18 * hurried.sites;
  const BakeResult stopped = bake(volume, {}, settings, builtin_stages(), {});
  EXPECT_EQ(stopped.skipped.count("rounds_beyond_memory"), 1u);
  EXPECT_GT(stopped.rmse_estimate, 0.02);
  EXPECT_GT(stopped.most_rays, 16u);
}

// Nothing of a white closed ball is known but that it is dark.
TEST(TexelTarget, CountsPlacesThatNobodyCanJudge) {
  Scene scene;
  scene.albedo = {.keys = {{0.0f, Vec3f(1.0f)}}};
  BakeSettings settings;
  settings.trace.rays = 4;
  settings.texels = Index3(8);
  const BakeResult result = bake(read_volume("gen:cavity:17"), scene, settings, builtin_stages(), {});
  ASSERT_EQ(result.skipped.count("places_unjudged"), 1u);
  EXPECT_GT(result.skipped.at("places_unjudged"), 20u);
  EXPECT_LT(result.skipped.at("places_unjudged"), 400u);
}

}  // namespace
}  // namespace isolux::test
