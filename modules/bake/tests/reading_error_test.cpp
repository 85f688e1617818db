// What reading reflections from texels is wrong by, where few sites can be held out to measure it.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace isolux::test {
namespace {

IlluminationGrid paths_of(const Volume& volume, std::uint64_t seed) {
  BakeSettings settings;
  settings.trace.rays = 1024;
  settings.bounce_method = BounceMethod::kPaths;
  return bake(volume, {}, settings, builtin_stages(), {.seed = seed}).light;
}

/// Of two unbiased lights with noise of their own the mean product of differences has none of it.
double true_error(const IlluminationGrid& light, const IlluminationGrid& one, const IlluminationGrid& other) {
  double sum = 0.0;
  for (std::size_t i = 0; i < light.values.size(); ++i)
    sum += (double(light.values[i]) - double(one.values[i])) * (double(light.values[i]) - double(other.values[i]));
  return std::sqrt(std::max(0.0, sum) / double(light.values.size()));
}

TEST(ReadingError, IsNotDeniedByALuckyDrawOfSites) {
  const Volume volume = read_volume("gen:hydrogen:13");
  const IlluminationGrid one = paths_of(volume, 901);
  const IlluminationGrid other = paths_of(volume, 902);
  BakeSettings settings;
  settings.trace.rays = 1024;
  for (const std::uint64_t seed : {2u, 5u, 8u, 11u}) {
    SCOPED_TRACE(seed);
    settings.target_rmse = 0.0;
    const BakeResult result = bake(volume, {}, settings, builtin_stages(), {.seed = seed});
    const double error = true_error(result.light, one, other);
    // One of eight sites, 216, can miss the few that are wrong: seeds 5 and 11 had a quarter and a fifth of the truth.
    EXPECT_GT(result.rmse_estimate, 0.45 * error);
    EXPECT_LT(result.rmse_estimate, 2.5 * error);
    settings.target_rmse = 0.004;
    const BakeResult asked = bake(volume, {}, settings, builtin_stages(), {.seed = seed});
    EXPECT_LT(true_error(asked.light, one, other), 1.4 * 0.004);  // formerly up to .0074
  }
}

}  // namespace
}  // namespace isolux::test
