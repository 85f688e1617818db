// Bakes towards an error or within a time whose rays are as many for every site.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/stopwatch.h>
#include <isolux/volume_io/read.h>

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

TEST(Target, EndsInTime) {
  const Volume volume = read_volume("gen:gyroid:20");
  BakeSettings settings;
  settings.trace.bounces = 0;
  settings.target_seconds = 0.5;
  settings.target_rmse = 1e-5;
  const Stopwatch watch;
  const BakeResult result = bake(volume, one_bright_pixel(), settings, builtin_stages(), {});
  EXPECT_LT(watch.seconds(), 2.0);
  EXPECT_GT(result.most_rays, 16u);
}

}  // namespace
}  // namespace isolux::test
