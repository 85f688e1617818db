// Bakes towards an error or within a time whose rays are as many for every site.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "grid_index.h"
#include "processor_time.h"
#include "rms_difference.h"

namespace isolux::test {
namespace {

/// Nearly all light is one pixel's: of few rays hardly one finds it, so that they say far too much of many.
Scene one_bright_pixel() {
  ImageEnvironment image{.width = 16, .height = 8, .pixels = std::vector<Vec3f>(128, Vec3f(0.05f))};
  image.pixels[2 * 16 + 5] = Vec3f(400.0f);
  Scene scene;
  scene.environment = image;
  return scene;
}

TEST(Target, TakesNoMoreRaysThanAnErrorWants) {
  const Volume volume = read_volume("gen:gyroid:20");
  const Scene scene = one_bright_pixel();
  BakeSettings settings;
  settings.trace = {.rays = 512, .bounces = 0};
  const IlluminationGrid truth = bake(volume, scene, settings, builtin_stages(), {.seed = 9}).light;
  settings.target_rmse = 0.1;
  const BakeResult result = bake(volume, scene, settings, builtin_stages(), {});
  EXPECT_LE(result.rmse_estimate, 0.1);
  EXPECT_LT(rms_difference(result.light, truth), 0.13);
  EXPECT_LT(result.most_rays, 200u);  // sixteen rays alone would ask for 1,400
}

TEST(Target, EndsIterationWhereReadingIsWrongAlready) {
  const Volume volume = read_volume("gen:noise:9");
  BakeSettings settings;
  settings.resampler.name = "fit";
  settings.bounce_method = BounceMethod::kIterated;
  settings.target_rmse = 0.004;
  Scene scene;
  scene.lights.emplace_back(SunLight{});
  const BakeResult result = bake(volume, scene, settings, builtin_stages(), {});
  EXPECT_GT(result.reading_error, 0.004);
  EXPECT_LT(result.most_rays, 1u << 14);
}

// Of white noise one site in three sees so little of the sky that its first rays all hit. It got no more rays and no
// error for it: in all the light was twice as wrong as was said.
TEST(Target, CountsSitesWhoseFirstRaysAgreeByLuck) {
  const Volume volume = read_volume("gen:noise:14");
  Scene scene;
  scene.environment = SkyEnvironment{};
  BakeSettings settings;
  settings.trace = {.rays = 2048, .bounces = 0};
  const IlluminationGrid truth = bake(volume, scene, settings, builtin_stages(), {.seed = 9}).light;
  settings.target_rmse = 0.004;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const BakeResult result = bake(volume, scene, settings, builtin_stages(), {.seed = seed});
    EXPECT_LE(result.rmse_estimate, 0.0042);
    EXPECT_LT(rms_difference(result.light, truth), 1.3 * result.rmse_estimate) << seed;
  }
}

struct Making {
  const char* name;
  std::function<void(BakeSettings&)> choose;
};

// Whatever makes texels of sites: noise averages out over many of them, and few leave gaps.
TEST(Target, IsWhatTexelsAreWrongBy) {
  const Volume volume = read_volume("gen:gyroid:16");
  const std::vector<Making> ways = {{"fit", [](BakeSettings& s) { s.resampler.name = "fit"; }},
                                    {"fit by need",
                                     [](BakeSettings& s) {
                                       s.resampler.name = "fit";
                                       s.texel_sites = TexelSites::kNeeded;
                                     }},
                                    {"many samples", [](BakeSettings& s) { s.samples = 30000; }},
                                    {"few samples", [](BakeSettings& s) { s.samples = 1500; }},
                                    {"denoised", [](BakeSettings& s) {
                                       s.resampler.settings = {{"denoise", "true"}};
                                     }}};
  for (const Making& way : ways) {
    BakeSettings settings;
    settings.trace = {.rays = 16, .bounces = 0};
    settings.wants_error_grid = true;
    way.choose(settings);
    const BakeResult result = bake(volume, {}, settings, builtin_stages(), {});
    BakeSettings exact;
    exact.trace = {.rays = 1024, .bounces = 0};
    exact.texels = result.light.lattice.size;
    const IlluminationGrid truth = bake(volume, {}, exact, builtin_stages(), {.seed = 9}).light;
    const LightReader reader(volume, result.light);
    const IndexToWorld to_volume = index_to_index(truth.lattice, volume.lattice());
    double squares = 0.0;
    for (std::size_t t = 0; t < truth.values.size(); ++t) {
      const Vec3 at = to_volume.world(Vec3(index_of(truth.lattice.size, t)));
      squares += std::pow(double(reader.at_index(at).x) - double(truth.values[t]), 2.0);
    }
    const double error = std::sqrt(squares / double(truth.values.size()));
    // One texel of eight is held out, some 400: their mean square is known to a tenth or so.
    EXPECT_LT(error, 1.25 * result.rmse_estimate) << way.name;
    EXPECT_GT(error, result.rmse_estimate / 1.25) << way.name;
    ASSERT_TRUE(result.error) << way.name;
    ASSERT_EQ(result.error->values.size(), truth.values.size()) << way.name;
    double stated = 0.0;
    for (const float e : result.error->values) {
      EXPECT_GE(e, 0.0f) << way.name;
      stated += double(e) * double(e) / double(truth.values.size());
    }
    EXPECT_NEAR(std::sqrt(stated), result.rmse_estimate, 1e-4) << way.name;
  }
}

TEST(Target, EndsInTime) {
  const Volume volume = read_volume("gen:gyroid:20");
  BakeSettings settings;
  settings.trace.bounces = 0;
  settings.target_seconds = 2.0;
  settings.target_rmse = 1e-5;
  std::uint64_t most_rays = 0;
  for (int attempt = 0; attempt < 3 && most_rays <= 4; ++attempt) {
    const ProcessorTime time;
    most_rays = bake(volume, one_bright_pixel(), settings, builtin_stages(), {.threads = 2}).most_rays;
    EXPECT_LT(time.seconds(), 6.0) << "two threads work 4 s";
  }
  // Which it begins with: a tenth of the time on slow machines, all of it only while others are busy on them.
  EXPECT_GT(most_rays, 4u);
}

// Sharper texels are right between themselves, and an error asked is their own.
TEST(Target, LeavesDenoisedTexelsBluntUnlessTold) {
  BakeSettings settings;
  settings.resampler.settings = {{"denoise", "true"}};
  const Lattice volume = read_volume("gen:gyroid:9").lattice();
  EXPECT_FALSE(with_defaults(settings, volume, builtin_stages()).resampler.settings.contains("sharpen"));
  settings.target_rmse = 0.02;
  EXPECT_EQ(with_defaults(settings, volume, builtin_stages()).resampler.settings.at("sharpen"), "false");
  settings.resampler.settings["sharpen"] = "true";
  EXPECT_EQ(with_defaults(settings, volume, builtin_stages()).resampler.settings.at("sharpen"), "true");
}

// Of long paths there are few for a tiny grid, but some.
TEST(Target, TinyGridsThatReflectNearlyAllSayTheirError) {
  Scene scene;
  scene.albedo = {.keys = {{0.0f, Vec3f(0.97f)}}};
  BakeSettings settings;
  settings.trace.rays = 2;
  const BakeResult result = bake(read_volume("gen:gyroid:4"), scene, settings, builtin_stages(), {});
  EXPECT_GT(result.rmse_estimate, 0.0);  // not NaN either
}

// Whatever way rays are spent, a time that is over at once ends with the fewest that tell an error, and says so.
TEST(Target, AShortTimeTakesTheFewestRays) {
  const Volume volume = read_volume("gen:gyroid:20");
  Scene sunny;
  sunny.lights.emplace_back(SunLight{});
  for (const bool lit_by_a_sun : {false, true}) {
    for (const BounceMethod method : {BounceMethod::kDefault, BounceMethod::kPaths}) {
      for (const int bounces : {0, kAllBounces}) {
        BakeSettings settings;
        settings.trace.bounces = bounces;
        settings.bounce_method = method;
        settings.target_seconds = 1e-4;
        settings.target_rmse = 1e-5;
        const BakeResult result = bake(volume, lit_by_a_sun ? sunny : Scene{}, settings, builtin_stages(), {});
        EXPECT_EQ(result.least_rays, 4u);
        EXPECT_EQ(result.most_rays, 4u);
        EXPECT_GT(result.rmse_estimate, 0.0);
        EXPECT_GT(result.seconds_beyond_time, 0.0);
      }
    }
  }
}

// Four rays can all miss what is bright: none is spent by need before there are sixteen, nor is an error believed.
TEST(Target, ATimeThatSufficesTakesAsManyRaysAsNone) {
  const Volume volume = read_volume("gen:gyroid:12");
  for (const int bounces : {0, kAllBounces}) {
    BakeSettings settings;
    settings.trace.bounces = bounces;
    settings.target_seconds = 60.0;
    settings.target_rmse = 1.0;
    const BakeResult result = bake(volume, {}, settings, builtin_stages(), {});
    EXPECT_EQ(result.least_rays, 16u);
    EXPECT_EQ(result.most_rays, 16u);
    EXPECT_EQ(result.seconds_beyond_time, 0.0);
  }
}

}  // namespace
}  // namespace isolux::test
