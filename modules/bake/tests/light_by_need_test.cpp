// Few texels traced and the others predicted: whether the error that is reached is the true one.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <utility>

namespace isolux::test {
namespace {

BakeSettings by_need(double rmse) {
  BakeSettings settings;
  settings.trace.bounces = 0;
  settings.target_rmse = rmse;
  settings.texel_sites = TexelSites::kNeeded;
  return settings;
}

double difference(const IlluminationGrid& a, const IlluminationGrid& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i) squares += std::pow(double(a.values[i]) - double(b.values[i]), 2.0);
  return std::sqrt(squares / double(a.values.size()));
}

TEST(LightByNeed, EstimatesTheTrueError) {
  for (const char* name : {"gen:two-spheres:21", "gen:ball-over-plane:21", "gen:gyroid:21"}) {
    SCOPED_TRACE(name);
    const Volume volume = read_volume(name);
    BakeSettings settings;
    settings.trace = {.rays = 512, .bounces = 0};
    isolux::Run other;
    other.seed = 2;
    // Of so many rays the error is a fifth of what is asked here, and independent.
    const IlluminationGrid reference = bake(volume, Scene{}, settings, builtin_stages(), other).light;
    const BakeResult result = bake(volume, Scene{}, by_need(0.02), builtin_stages(), isolux::Run{});
    EXPECT_LE(result.rmse_estimate, 0.02);
    const double found = difference(result.light, reference);
    EXPECT_LT(found, 1.3 * result.rmse_estimate);
    EXPECT_GT(found, result.rmse_estimate / 1.3);
  }
}

TEST(LightByNeed, PredictsMostOfSmoothLight) {
  // e = (1 + n.up)/2 on every sphere: smooth but for the centre.
  const Volume volume = read_volume("gen:sphere:33");
  Scene scene;
  scene.environment = SkyEnvironment{.ground = Vec3f(0.0f)};
  const BakeResult result = bake(volume, scene, by_need(0.03), builtin_stages(), isolux::Run{});
  EXPECT_LT(double(result.sites), 0.25 * double(result.light.lattice.count()));
  EXPECT_EQ(result.sites + result.skipped.at("texels_predicted") + result.unlit_texels, result.light.lattice.count());
}

TEST(LightByNeed, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Volume volume = read_volume("gen:gyroid:17");
  const auto light = [&](int threads) {
    isolux::Run run;
    run.threads = threads;
    BakeSettings settings = by_need(0.03);
    settings.wants_error_grid = true;
    const BakeResult result = bake(volume, Scene{}, settings, builtin_stages(), run);
    return std::pair(result.light.values, result.error->values);
  };
  EXPECT_EQ(light(1), light(3));
}

TEST(LightByNeed, RefusesWhatItCannotPredict) {
  const Volume volume = read_volume("gen:sphere:9");
  BakeSettings settings = by_need(0.03);
  settings.trace.bounces = 1;
  EXPECT_THROW((void)bake(volume, Scene{}, settings, builtin_stages(), isolux::Run{}), InvalidInput);
  settings = by_need(0.0);
  EXPECT_THROW((void)bake(volume, Scene{}, settings, builtin_stages(), isolux::Run{}), InvalidInput);
}

}  // namespace
}  // namespace isolux::test
