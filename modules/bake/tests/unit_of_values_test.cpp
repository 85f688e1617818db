// Light does not depend on the unit of the volume's values: in steps of powers of two not by a bit.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <functional>

namespace isolux::test {
namespace {

struct Way {
  const char* name;
  std::function<void(BakeSettings&)> choose;
};

std::vector<Way> ways() {
  return {{"texels", [](BakeSettings& s) { s.trace.bounces = 0; }},
          {"texels, all bounces", [](BakeSettings&) {}},
          {"paths",
           [](BakeSettings& s) {
             s.bounce_method = BounceMethod::kPaths;
             s.trace.bounces = 1;
           }},
          {"denoised",
           [](BakeSettings& s) {
             s.trace.bounces = 0;
             s.resampler.settings = {{"denoise", "true"}};
           }},
          {"fit", [](BakeSettings& s) { s.resampler.name = "fit"; }},
          {"moving least squares",
           [](BakeSettings& s) {
             s.resampler.name = "moving_least_squares";
             s.samples = 2000;
           }},
          {"by need", [](BakeSettings& s) {
             s.texel_sites = TexelSites::kNeeded;
             s.target_rmse = 0.05;
           }}};
}

class UnitsOfValues : public ::testing::TestWithParam<int> {};

TEST_P(UnitsOfValues, MakesNoDifference) {
  Volume volume = read_volume("gen:noise:12");
  Volume scaled = volume;
  for (float& value : scaled.values.values()) value = std::ldexp(value, GetParam());
  for (const Way& way : ways()) {
    BakeSettings settings;
    settings.trace.rays = 8;
    way.choose(settings);
    const BakeResult usual = bake(volume, {}, settings, builtin_stages(), {});
    const BakeResult other = bake(scaled, {}, settings, builtin_stages(), {});
    EXPECT_EQ(other.light.values, usual.light.values) << way.name;
  }
}

/// `value` of 0 to 1 stretched to a range that a power of two has no part in.
Volume noise_between(float low, float high) {
  Volume volume = read_volume("gen:noise:9");
  const ValueRange range = value_range(volume);
  for (float& value : volume.values.values()) {
    const double part = (double(value) - double(range.low)) / (double(range.high) - double(range.low));
    value = float(double(low) + part * (double(high) - double(low)));
  }
  return volume;
}

// Differences of values of both signs are larger than either.
TEST(UnitOfValues, MayReachTheEndOfFloats) {
  const Volume usual = noise_between(-1.0f, 1.0f);
  const Volume large = noise_between(-0.85e38f, 0.85e38f);
  for (const Way& way : ways()) {
    BakeSettings settings;
    settings.trace.rays = 16;
    way.choose(settings);
    const BakeResult expected = bake(usual, {}, settings, builtin_stages(), {});
    const BakeResult actual = bake(large, {}, settings, builtin_stages(), {});
    const LightReader of_usual(usual, expected.light);
    const LightReader of_large(large, actual.light);
    for (const Vec3& at : {Vec3(2.3, 4.1, 3.7), Vec3(5.2, 1.9, 6.6), Vec3(3.4, 5.5, 4.5)})
      EXPECT_NEAR(of_large.at_index(at).x, of_usual.at_index(at).x, 0.02f) << way.name;
  }
}

TEST(UnitOfValues, IsRefusedWhereFloatsDoNotTellDifferences) {
  EXPECT_THROW((void)bake(noise_between(-3e38f, 3e38f), {}, {}, builtin_stages(), {}), InvalidInput);
  EXPECT_THROW((void)light_points(noise_between(-3e38f, 3e38f), {}, {}, {}, {}, builtin_stages(), {}), InvalidInput);
  EXPECT_THROW((void)bake(noise_between(0.0f, 1e-38f), {}, {}, builtin_stages(), {}), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(PowersOfTwo, UnitsOfValues, ::testing::Values(-100, -60, 60, 110));

}  // namespace
}  // namespace isolux::test
