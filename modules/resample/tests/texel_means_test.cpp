// Means of scattered samples around the texels.
#include <gtest/gtest.h>
#include <isolux/resample.h>

#include <algorithm>
#include <cmath>

#include "support.h"

namespace isolux {
namespace {

using testing::add_sample;
using testing::ramp_volume;
using testing::random_samples;

TEST(TexelMeans, KeepConstants) {
  const Volume volume = ramp_volume({9, 8, 7}, {1.0, 2.0, 0.5});
  for (const Index3 size : {Index3(8, 7, 6), Index3(1, 7, 6), Index3(1, 1, 1), Index3(5, 11, 2)}) {
    const SampleSet samples = random_samples(volume, 900, 3, [](const Vec3&, int c) { return 0.4f + float(c); });
    const Lattice texels = cell_lattice(volume.lattice(), size);
    const ResampledGrid means = TexelMeans(volume, samples.sites, texels, {}).of(samples.radiance, 3, {});
    ASSERT_EQ(means.lit.size(), texels.count());
    for (std::size_t v = 0; v < means.grid.values.size(); ++v) {
      if (means.lit[v / 3] == 0) continue;
      EXPECT_NEAR(means.grid.values[v], 0.4f + float(v % 3), 1e-6f);  // weights add up to rounding
    }
  }
}

// Two samples between the centres of texels (0,0,0) and (1,0,0), at a quarter and three quarters of the way.
TEST(TexelMeans, WeightAsReadingDoes) {
  const Volume volume = ramp_volume({5, 5, 5});
  SampleSet samples;
  add_sample(samples, volume, {0.75, 0.5, 0.5}, {1.0f});
  add_sample(samples, volume, {1.25, 0.5, 0.5}, {5.0f});
  const Lattice texels = cell_lattice(volume.lattice());
  const ResampledGrid means = TexelMeans(volume, samples.sites, texels, {}).of(samples.radiance, 1, {});
  // .75 and .25 add up to one; exact in floats.
  EXPECT_EQ(means.grid.values[0], 0.75f * 1.0f + 0.25f * 5.0f);
  EXPECT_EQ(means.grid.values[1], 0.25f * 1.0f + 0.75f * 5.0f);
  EXPECT_EQ(std::count(means.lit.begin(), means.lit.end(), std::uint8_t(1)), 2);
}

TEST(TexelMeans, AreTheSameForAnyNumberOfThreads) {
  const Volume volume = ramp_volume({12, 12, 12});
  const SampleSet samples =
      random_samples(volume, 8000, 1, [](const Vec3& p, int) { return float(std::sin(3.0 * p.x + p.y)); });
  const Lattice texels = cell_lattice(volume.lattice());
  const auto means = [&](int threads) {
    const isolux::Run run{.threads = threads};
    return TexelMeans(volume, samples.sites, texels, run).of(samples.radiance, 1, run).grid.values;
  };
  EXPECT_EQ(means(1), means(4));
}

}  // namespace
}  // namespace isolux
