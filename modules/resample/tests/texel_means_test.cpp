// Means of scattered samples around the texels.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
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
      // Rounding of at most 900 additions, where there is one texel.
      const float constant = 0.4f + float(v % 3);
      EXPECT_NEAR(means.grid.values[v], constant, constant * 900.0f * 0x1p-24f);
    }
  }
}

// Two samples between the centres of texels (0,0,0) and (1,0,0), at a quarter and three quarters of the way and on one
// level set, so that nothing is said of slopes.
TEST(TexelMeans, WeightAsReadingDoes) {
  const Volume volume = testing::make_volume({5, 5, 5}, Vec3(1.0), [](const Vec3& p) { return p.y; });
  SampleSet samples;
  add_sample(samples, volume, {0.75, 0.5, 0.5}, {1.0f});
  add_sample(samples, volume, {1.25, 0.5, 0.5}, {5.0f});
  const Lattice texels = cell_lattice(volume.lattice());
  const ResampledGrid means = TexelMeans(volume, samples.sites, texels, {}).of(samples.radiance, 1, {});
  // .75 and .25 add up to one; exact in floats.
  EXPECT_EQ(means.grid.values[0], 0.75f * 1.0f + 0.25f * 5.0f);
  EXPECT_EQ(means.grid.values[1], 0.25f * 1.0f + 0.75f * 5.0f);
  EXPECT_EQ(means.grid.detail.slopes[0], 0.0f);
  EXPECT_EQ(std::count(means.lit.begin(), means.lit.end(), std::uint8_t(1)), 2);
}

TEST(TexelMeans, FollowLightThatIsLinearInTheIsovalue) {
  // Values far from zero: what counts is how far they lie apart.
  for (const double offset : {0.0, 3000.0}) {
    const Volume volume = testing::make_volume({9, 9, 9}, Vec3(1.0),
                                               [&](const Vec3& p) { return offset + p.x + 0.25 * p.y - 0.5 * p.z; });
    const SampleSet samples = random_samples(
        volume, 64 * 512, 1, [](const Vec3& p, int) { return float(2.0 + 0.5 * (p.x + 0.25 * p.y - 0.5 * p.z)); });
    const Lattice texels = cell_lattice(volume.lattice());
    const ResampledGrid means = TexelMeans(volume, samples.sites, texels, {}).of(samples.radiance, 1, {});
    const TrilinearField field(volume);
    for (std::size_t t = 0; t < texels.count(); ++t) {
      const Vec3 centre = Vec3(t % 8, t / 8 % 8, t / 64) + 0.5;
      // A texel's prior weighs as a quarter of one of its some 64 samples (a tent holds as many as a cell), at most .25
      // / 8 of them at a corner of the box, where the samples' mean lies up to .2 isovalues off; the isovalues'
      // rounding at 3000 is 2e-4.
      EXPECT_NEAR(means.grid.detail.slopes[t], 0.5f, 0.5f * 0.02f);
      EXPECT_NEAR(means.grid.values[t], 2.0 + 0.5 * (field.value(centre) - offset), 0.005);
    }
  }
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

TEST(TexelMeans, RefuseLightThatIsNotOneASite) {
  const Volume volume = ramp_volume({5, 5, 5}, Vec3(1.0));
  const SampleSet samples = random_samples(volume, 90, 1, [](const Vec3&, int) { return 1.0f; });
  const TexelMeans means(volume, samples.sites, cell_lattice(volume.lattice()), {});
  EXPECT_NO_THROW((void)means.of(samples.radiance, 1, {}));
  EXPECT_THROW((void)means.of(samples.radiance, 3, {}), InvalidInput);
  const std::vector<float> two(180, 1.0f);
  EXPECT_THROW((void)means.of(two, 2, {}), InvalidInput);
}

}  // namespace
}  // namespace isolux
