// Light does not depend on the unit of the volume's values: in steps of powers of two not by a bit.
#include <gtest/gtest.h>
#include <isolux/bake.h>
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

class UnitOfValues : public ::testing::TestWithParam<int> {};

TEST_P(UnitOfValues, MakesNoDifference) {
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

INSTANTIATE_TEST_SUITE_P(PowersOfTwo, UnitOfValues, ::testing::Values(-100, -60, 60, 110));

}  // namespace
}  // namespace isolux::test
