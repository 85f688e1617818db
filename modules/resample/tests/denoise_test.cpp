#include "denoise.h"

#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <cstddef>
#include <limits>

#include "sample_window.h"
#include "support.h"

namespace isolux {
namespace {

/// Noisy samples in a long box with holes, two at some texels, and noisy lamps' light told apart.
SampleSet noisy_samples(const Volume& volume) {
  SampleSet samples;
  RandomStream random(5, 0);
  const Index3 cells = volume.lattice().size - 1;
  const auto add = [&](const Vec3& at) {
    const double noise = 0.2 * (random.uniform_double() - 0.5);
    testing::add_sample(samples, volume, at, {float(1.0 + 0.3 * std::sin(at.z) + noise)}, 0.04f / 12.0f);
    samples.lamps.push_back(float(0.1 + noise / 2.0));
    samples.lamps_variance.push_back(0.01f / 12.0f);
  };
  for (int k = 0; k < cells.z; ++k)
    for (int j = 0; j < cells.y; ++j)
      for (int i = 0; i < cells.x; ++i)
        for (double kept = 1.4 * random.uniform_double(); kept > 0.5; kept -= 0.7) add(Vec3(i, j, k) + 0.5);
  return samples;
}

TEST(Denoise, GivesTheSameBitsHoweverManyLayersAreHeld) {
  const Volume volume = testing::ramp_volume({18, 6, 90});
  const Lattice texels = cell_lattice(volume.lattice());
  const SampleSet samples = noisy_samples(volume);
  const DenoisedLight at_once = denoised_light(volume, samples, texels, {}, std::numeric_limits<std::size_t>::max());
  const DenoisedLight by_layers = denoised_light(volume, samples, texels, {}, 1);
  EXPECT_EQ(by_layers.rest, at_once.rest);
  EXPECT_EQ(by_layers.lamps, at_once.lamps);
  EXPECT_EQ(by_layers.noisy_rest, at_once.noisy_rest);
}

// Of two samples at a texel the mean, channel by channel, up to rounding: some 2^-23 of each.
TEST(Denoise, KeepsEachChannelsConstant) {
  const Volume volume = testing::ramp_volume({8, 7, 6});
  SampleSet samples;
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 7; ++i)
        for (int copy = 0; copy <= i % 2; ++copy)
          testing::add_sample(samples, volume, Vec3(i, j, k) + 0.5, {0.25f, 1.5f, 4.0f}, 0.01f);
  const DenoisedLight light = denoised_light(volume, samples, cell_lattice(volume.lattice()), {});
  ASSERT_EQ(light.rest.size(), samples.radiance.size());
  for (std::size_t v = 0; v < light.rest.size(); v += 3) {
    EXPECT_NEAR(light.rest[v], 0.25, 1e-6);
    EXPECT_NEAR(light.rest[v + 1], 1.5, 1e-6);
    EXPECT_NEAR(light.rest[v + 2], 4.0, 4e-6);
  }
}

TEST(SampleWindow, HoldsWhatIsNotLetGo) {
  SampleWindow<int> window(2, 5);
  window.hold_until(4);
  for (std::size_t s = 0; s < 4; ++s) window.of(s)[1] = int(s);
  window.let_go_before(3);
  window.hold_until(6);
  EXPECT_EQ(window.of(3)[1], 3);
  EXPECT_EQ(window.of(4)[1], 0);
  EXPECT_EQ(window.of(5)[0], 0);
}

}  // namespace
}  // namespace isolux
