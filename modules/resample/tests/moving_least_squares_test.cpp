#include <gtest/gtest.h>
#include <isolux/resample.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support.h"

namespace isolux {
namespace {

using testing::add_sample;
using testing::ramp_volume;
using testing::random_samples;

ResampledGrid smoothed(const Volume& volume, const SampleSet& samples, const Lattice& texels, Settings settings = {},
                       const isolux::Run& run = {}) {
  return resamplers().create("moving_least_squares", settings)->resample(volume, samples, texels, run);
}

TEST(MovingLeastSquares, ReproducesConstantsExactly) {
  const Volume volume = ramp_volume({9, 7, 8}, {1.0, 0.5, 3.0});
  for (const int channels : {1, 3}) {
    const SampleSet samples = random_samples(volume, 900, channels, [](const Vec3&, int c) { return 0.7f + float(c); });
    const IlluminationGrid light = smoothed(volume, samples, cell_lattice(volume.lattice())).grid;
    for (std::size_t v = 0; v < light.values.size(); ++v) {
      ASSERT_EQ(light.values[v], 0.7f + float(v % std::size_t(channels)));
    }
  }
}

// Linear precision up to the ridge (2 percent of the slope) over sample distances of half a voxel; Shepard's
// interpolant, which has none, is the measure.
TEST(MovingLeastSquares, FollowsALinearRampBetterThanShepard) {
  const Volume volume = ramp_volume({9, 9, 9});
  const Lattice texels = cell_lattice(volume.lattice());
  const auto ramp = [](const Vec3& p, int) { return float(p.x - 0.5 * p.y + 2.0 * p.z); };
  const SampleSet samples = random_samples(volume, 4000, 1, ramp);
  const auto error = [&](const IlluminationGrid& light) {
    double squares = 0.0;
    for (int k = 1; k < 7; ++k)
      for (int j = 1; j < 7; ++j)
        for (int i = 1; i < 7; ++i) {
          const double e = double(light.values[texels.offset(i, j, k)]) - double(ramp(Vec3(i, j, k) + 0.5, 0));
          squares += e * e;
        }
    return std::sqrt(squares / 216.0);
  };
  const double shepard = error(resamplers().create("cell_grid")->resample(volume, samples, texels, {}).grid);
  EXPECT_LT(error(smoothed(volume, samples, texels).grid), 0.2 * shepard);
}

TEST(MovingLeastSquares, TakesMoreSamplesTheNoisierTheyAre) {
  const Volume volume = ramp_volume({9, 9, 9});
  std::uint64_t at = 0;
  SampleSet samples = random_samples(
      volume, 4000, 1, [&](const Vec3&, int) { return 0.5f + 0.6f * (RandomStream(4, at++).uniform_float() - 0.5f); });
  const auto error = [&] {
    double squares = 0.0;
    const IlluminationGrid light = smoothed(volume, samples, cell_lattice(volume.lattice())).grid;
    for (const float v : light.values) squares += double(v - 0.5f) * double(v - 0.5f);
    return std::sqrt(squares / double(light.values.size()));
  };
  const double unaware = error();
  samples.variance.assign(samples.size(), 0.03f);
  // From 16 samples to some 60: the noise left falls to about half.
  EXPECT_LT(error(), 0.7 * unaware);
}

// A tracer gives the largest float to samples of which it knows no variance: they say nothing of the others'.
TEST(MovingLeastSquares, LeavesOutVariancesThatNobodyKnows) {
  const Volume volume = ramp_volume({9, 9, 9});
  const Lattice texels = cell_lattice(volume.lattice());
  SampleSet samples = random_samples(volume, 4000, 1, [](const Vec3& p, int) { return float(std::sin(p.x)); });
  const ResampledGrid known = smoothed(volume, samples, texels);
  samples.variance[7] = std::numeric_limits<float>::max();
  EXPECT_EQ(smoothed(volume, samples, texels).grid.values, known.grid.values);
}

TEST(MovingLeastSquares, StandsDegenerateSamples) {
  const Volume volume = ramp_volume({5, 5, 5});
  const Lattice texels = cell_lattice(volume.lattice());
  SampleSet one;
  add_sample(one, volume, Vec3(0.5), {0.3f});
  for (const float v : smoothed(volume, one, texels).grid.values) EXPECT_EQ(v, 0.3f);
  SampleSet line;
  for (int i = 0; i < 40; ++i) add_sample(line, volume, Vec3(0.1 * i, 2.0, 2.0), {float(i)});
  SampleSet same;
  for (int i = 0; i < 40; ++i) add_sample(same, volume, Vec3(1.5), {float(i)});
  for (const SampleSet& set : {line, same}) {
    for (const Settings& settings : {Settings{}, Settings{{"isovalue_length", "5"}, {"normal_power", "2"}}}) {
      for (const float v : smoothed(volume, set, texels, settings).grid.values) {
        EXPECT_GE(v, 0.0f);
        EXPECT_LE(v, 39.0f);
      }
    }
  }
}

// Beside a shadow's edge, lines through the samples of both sides leave the light of either.
TEST(MovingLeastSquares, StaysWithinTheLightThatThereIs) {
  const Volume volume = ramp_volume({13, 13, 13});
  for (const int channels : {1, 3}) {
    const auto shadow = [](const Vec3& p, int c) { return p.x + 0.3 * p.y < 7.5 ? 1.0f : 2.0f + float(c); };
    const SampleSet samples = random_samples(volume, 6000, channels, shadow);
    const IlluminationGrid light = smoothed(volume, samples, cell_lattice(volume.lattice())).grid;
    for (std::size_t v = 0; v < light.values.size(); ++v) {
      EXPECT_GE(light.values[v], 1.0f);
      EXPECT_LE(light.values[v], 2.0f + float(v % std::size_t(channels)));
    }
  }
}

TEST(MovingLeastSquares, IsTheSameForAnyNumberOfThreads) {
  const Volume volume = ramp_volume({20, 21, 22});
  const SampleSet samples = random_samples(volume, 3000, 1, [](const Vec3& p, int) { return float(std::sin(p.x)); });
  const Lattice texels = cell_lattice(volume.lattice());
  EXPECT_EQ(smoothed(volume, samples, texels, {}, {.threads = 1}).grid.values,
            smoothed(volume, samples, texels, {}, {.threads = 4}).grid.values);
}

}  // namespace
}  // namespace isolux
