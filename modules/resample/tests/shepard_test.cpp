#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/resample.h>

#include <algorithm>
#include <cmath>

#include "support.h"

namespace isolux {
namespace {

using testing::add_sample;
using testing::make_volume;
using testing::ramp_volume;
using testing::random_samples;

/// Every backend that has Shepard's options.
std::vector<std::string> shepard_backends() {
  std::vector<std::string> names;
  const Registry<Resampler> registry = resamplers();
  for (const BackendInfo& info : registry.backends()) {
    const auto has = [&](std::string_view option) {
      return std::any_of(info.options.begin(), info.options.end(), [&](const auto& o) { return o.name == option; });
    };
    if (info.unavailable.empty() && has("k") && has("exponent") && has("isovalue_length")) names.push_back(info.name);
  }
  return names;
}

class Shepard : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] ResampledGrid resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                                       const Settings& settings, const isolux::Run& run = {}) const {
    return resamplers().create(GetParam(), settings)->resample(volume, samples, texels, run);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, Shepard, ::testing::ValuesIn(shepard_backends()),
                         [](const auto& backend) { return backend.param; });

float bumpy(const Vec3& p, int channel) { return float(std::sin(p.x + channel) + std::cos(0.7 * p.y) + 0.1 * p.z); }

TEST(ShepardBackends, AreThereBesideTheOracle) {
  const std::vector<std::string> names = shepard_backends();
  EXPECT_GE(names.size(), 2u);
  EXPECT_TRUE(std::find(names.begin(), names.end(), "brute_force") != names.end());
}

TEST_P(Shepard, ReproducesConstantsExactly) {
  const Volume volume = ramp_volume({9, 7, 8}, {1.0, 0.5, 3.0});
  for (const int channels : {1, 3}) {
    const SampleSet samples = random_samples(volume, 500, channels, [](const Vec3&, int c) { return 0.7f + float(c); });
    const ResampledGrid result = resample(volume, samples, cell_lattice(volume.lattice()), {});
    EXPECT_EQ(result.grid.channels, channels);
    for (std::size_t v = 0; v < result.grid.values.size(); ++v) {
      ASSERT_EQ(result.grid.values[v], 0.7f + float(v % std::size_t(channels)));
    }
  }
}

TEST_P(Shepard, EqualsBruteForceBitForBit) {
  const Volume volume = ramp_volume({12, 9, 7}, {1.0, 0.5, 3.0});
  const Lattice texels = cell_lattice(volume.lattice(), {7, 5, 4});
  const SampleSet samples = random_samples(volume, 300, 3, bumpy);
  for (const std::string distance : {"euclidean", "city_block", "chebyshev"}) {
    for (const std::string exponent : {"0", "0.5", "1", "2", "3.3", "7"}) {
      for (const std::string k : {"1", "2", "11", "60", "400"}) {
        for (const std::string length : {"0", "8"}) {
          const Settings settings{
              {"k", k}, {"exponent", exponent}, {"distance", distance}, {"isovalue_length", length}};
          const ResampledGrid mine = resample(volume, samples, texels, settings);
          const ResampledGrid oracle =
              resamplers().create("brute_force", settings)->resample(volume, samples, texels, {});
          ASSERT_EQ(mine.grid.values, oracle.grid.values) << distance << " p=" << exponent << " k=" << k;
          ASSERT_EQ(mine.lit, oracle.lit);
        }
      }
    }
  }
}

TEST_P(Shepard, EqualsBruteForceWithinARadius) {
  const Volume volume = ramp_volume({12, 9, 7}, {1.0, 0.5, 3.0});
  const Lattice texels = cell_lattice(volume.lattice());
  const SampleSet samples = random_samples(volume, 300, 1, bumpy);
  for (const std::string distance : {"euclidean", "city_block", "chebyshev"}) {
    for (const std::string radius : {"0.01", "0.7", "2.5", "1000"}) {
      for (const std::string k : {"0", "3"}) {
        const Settings settings{{"k", k}, {"radius", radius}, {"distance", distance}};
        const ResampledGrid mine = resample(volume, samples, texels, settings);
        const ResampledGrid oracle =
            resamplers().create("brute_force", settings)->resample(volume, samples, texels, {});
        ASSERT_EQ(mine.grid.values, oracle.grid.values) << distance << " radius=" << radius << " k=" << k;
        ASSERT_EQ(mine.lit, oracle.lit);
      }
    }
  }
}

TEST_P(Shepard, EqualsBruteForceInFlatAndThinBoxes) {
  for (const Vec3& spacing : {Vec3(1e-8, 1, 1), Vec3(1, 1, 1e-8), Vec3(1, 1e-8, 1e-8)}) {
    const Volume volume = ramp_volume({8, 8, 8}, spacing);
    const SampleSet samples = random_samples(volume, 500, 1, bumpy);
    const Lattice texels = cell_lattice(volume.lattice());
    const Settings settings{{"k", "11"}};
    EXPECT_EQ(resample(volume, samples, texels, settings).grid.values,
              resamplers().create("brute_force", settings)->resample(volume, samples, texels, {}).grid.values);
  }
}

// Samples on a lattice are the worst case of equally near ones: all backends must take the same.
TEST_P(Shepard, ResolvesTiesByTheSamplesIndex) {
  const Volume volume = ramp_volume({7, 7, 7});
  SampleSet samples;
  for (int q = 0; q < 343; ++q) add_sample(samples, volume, Vec3(q % 7, q / 7 % 7, q / 49), {float(q * 37 % 101)});
  for (const std::string distance : {"euclidean", "city_block", "chebyshev"}) {
    for (const std::string k : {"1", "5", "11", "30"}) {
      const Settings settings{{"k", k}, {"distance", distance}};
      for (const Lattice& texels : {cell_lattice(volume.lattice()), cell_lattice(volume.lattice(), {12, 12, 12})}) {
        const ResampledGrid mine = resample(volume, samples, texels, settings);
        const ResampledGrid oracle =
            resamplers().create("brute_force", settings)->resample(volume, samples, texels, {});
        ASSERT_EQ(mine.grid.values, oracle.grid.values) << distance << " k=" << k;
      }
    }
  }
  const ResampledGrid one = resample(volume, samples, cell_lattice(volume.lattice()), {{"k", "1"}});
  EXPECT_EQ(one.grid.values[0], samples.radiance[0]);  // of eight at one distance the first
}

TEST_P(Shepard, GivesASampleAtATexelItsValue) {
  const Volume volume = ramp_volume({9, 8, 7}, {0.3, 1.7, 5.0});
  const Lattice texels = cell_lattice(volume.lattice(), {11, 5, 9});
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  SampleSet samples = random_samples(volume, 200, 1, bumpy);
  std::vector<std::pair<std::size_t, float>> wanted;
  for (const Index3 at : {Index3(0, 0, 0), Index3(10, 4, 8), Index3(3, 2, 7)}) {
    wanted.emplace_back(texels.offset(at.x, at.y, at.z), float(wanted.size()) + 40.0f);
    add_sample(samples, volume, to_volume.world(Vec3(at)), {wanted.back().second});
  }
  for (const std::string exponent : {"0", "0.5", "2", "64"}) {
    const ResampledGrid result = resample(volume, samples, texels, {{"exponent", exponent}});
    for (const auto& [texel, value] : wanted) EXPECT_EQ(result.grid.values[texel], value);
    for (const float v : result.grid.values) ASSERT_TRUE(std::isfinite(v));
  }
}

TEST_P(Shepard, AveragesDuplicatesAtATexel) {
  const Volume volume = ramp_volume({3, 3, 3});
  SampleSet samples;
  for (const float v : {1.0f, 2.0f, 6.0f}) add_sample(samples, volume, Vec3(0.5), {v});
  add_sample(samples, volume, Vec3(1.0), {100.0f});
  const ResampledGrid result = resample(volume, samples, cell_lattice(volume.lattice()), {});
  EXPECT_EQ(result.grid.values[0], 3.0f);
}

TEST_P(Shepard, SpreadsOneSampleOverAll) {
  const Volume volume = ramp_volume({4, 4, 4});
  SampleSet samples;
  add_sample(samples, volume, {0.2, 2.9, 1.1}, {0.3f, 0.4f, 0.5f});
  const ResampledGrid result = resample(volume, samples, cell_lattice(volume.lattice()), {});
  for (std::size_t v = 0; v < result.grid.values.size(); ++v) EXPECT_EQ(result.grid.values[v], samples.radiance[v % 3]);
}

TEST_P(Shepard, LeavesTexelsWithNoSampleInReachUnlit) {
  const Volume volume = ramp_volume({5, 5, 5}, Vec3(2.0));
  SampleSet samples;
  add_sample(samples, volume, Vec3(0.5), {1.0f});
  // Texel centres lie 2 world units apart, so a radius of 2.1 reaches the sample's own and its three face neighbours.
  const ResampledGrid result = resample(volume, samples, cell_lattice(volume.lattice()), {{"radius", "2.1"}});
  EXPECT_EQ(std::count(result.lit.begin(), result.lit.end(), std::uint8_t(1)), 4);
}

TEST_P(Shepard, StaysBetweenItsSamples) {
  const Volume volume = ramp_volume({9, 7, 8});
  const SampleSet samples = random_samples(volume, 400, 1, bumpy);
  const auto [low, high] = std::minmax_element(samples.radiance.begin(), samples.radiance.end());
  for (const float v : resample(volume, samples, cell_lattice(volume.lattice()), {}).grid.values) {
    EXPECT_GE(v, *low);
    EXPECT_LE(v, *high);
  }
}

// Shepard's interpolant has no linear precision; its error on a ramp falls with the distance of the samples, so eight
// times the samples must leave well under three quarters of it (half of it in the limit).
TEST_P(Shepard, ConvergesOnALinearRamp) {
  const Volume volume = ramp_volume({9, 9, 9});
  const Lattice texels = cell_lattice(volume.lattice());
  const auto ramp = [](const Vec3& p, int) { return float(p.x - 0.5 * p.y + 2.0 * p.z); };
  const auto error = [&](std::size_t count) {
    const ResampledGrid result = resample(volume, random_samples(volume, count, 1, ramp), texels, {});
    double sum = 0.0;
    for (int k = 0; k < 8; ++k)
      for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
          const double e =
              double(result.grid.values[texels.offset(i, j, k)]) - double(ramp(Vec3(i + 0.5, j + 0.5, k + 0.5), 0));
          sum += e * e;
        }
    return std::sqrt(sum / 512.0);
  };
  EXPECT_LT(error(8000), 0.75 * error(1000));
}

TEST_P(Shepard, TellsLevelSetsApartByIsovalue) {
  // Two sheets of different light, half a texel apart in space and far apart in value.
  const Volume volume = make_volume({9, 9, 9}, Vec3(1.0), [](const Vec3& p) { return 100.0 * p.x; });
  SampleSet samples;
  for (int q = 0; q < 64; ++q) {
    const int row = q / 8;
    add_sample(samples, volume, {3.5, 0.5 + q % 8, 0.5 + row}, {1.0f});
    add_sample(samples, volume, {4.0, 0.5 + q % 8, 0.5 + row}, {9.0f});
  }
  // The texels at 3.7 have the sheets .2 and .3 of a voxel away, or 20 and 30 once the whole range counts 800.
  const Lattice texels = cell_lattice(volume.lattice(), {40, 8, 8});
  const float in_space =
      resample(volume, samples, texels, {{"k", "11"}, {"exponent", "1"}}).grid.values[texels.offset(18, 4, 4)];
  const float by_isovalue =
      resample(volume, samples, texels, {{"k", "11"}, {"exponent", "1"}, {"isovalue_length", "800"}})
          .grid.values[texels.offset(18, 4, 4)];
  EXPECT_GT(in_space, 2.0f);
  EXPECT_EQ(by_isovalue, 1.0f);
}

/// Root mean square of what the texels of bumpy light are wrong by, the samples' noise uniform of this root mean
/// square.
double error_beside_noise(const std::string& backend, double noise, const Settings& settings) {
  const Volume volume = ramp_volume({13, 13, 13});
  const Lattice texels = cell_lattice(volume.lattice());
  SampleSet samples = random_samples(volume, 1728, 1, bumpy);
  for (std::size_t s = 0; s < samples.size(); ++s)
    samples.radiance[s] += float(noise * std::sqrt(12.0) * (RandomStream(7, s).uniform_double() - 0.5));
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  const ResampledGrid result = resamplers().create(backend, settings)->resample(volume, samples, texels, {});
  double squares = 0.0;
  for (std::size_t t = 0; t < texels.count(); ++t) {
    const Vec3 p = to_volume.world(Vec3(t % 12, t / 12 % 12, t / 144));
    squares += std::pow(double(result.grid.values[t]) - double(bumpy(p, 0)), 2.0);
  }
  return std::sqrt(squares / double(texels.count()));
}

// Near samples alone serve exact ones and many alike serve noisy ones; what is chosen must be within a tenth of the
// better of both at either end, which neither is by itself.
TEST_P(Shepard, FollowsTheNoiseOfTheSamples) {
  const Settings near{{"k", "11"}, {"exponent", "2"}};
  const Settings alike{{"k", "64"}, {"exponent", "0"}};
  for (const double noise : {0.0, 1.5}) {
    const double best =
        std::min(error_beside_noise(GetParam(), noise, near), error_beside_noise(GetParam(), noise, alike));
    EXPECT_LT(error_beside_noise(GetParam(), noise, {}), 1.1 * best) << noise;
  }
  EXPECT_GT(error_beside_noise(GetParam(), 1.5, near), 1.3 * error_beside_noise(GetParam(), 1.5, {}));
  EXPECT_GT(error_beside_noise(GetParam(), 0.0, alike), 1.3 * error_beside_noise(GetParam(), 0.0, {}));
}

TEST_P(Shepard, IsTheSameForAnyNumberOfThreads) {
  const Volume volume = ramp_volume({20, 21, 22});
  const SampleSet samples = random_samples(volume, 3000, 1, bumpy);
  const Lattice texels = cell_lattice(volume.lattice());
  EXPECT_EQ(resample(volume, samples, texels, {}, {.threads = 1}).grid.values,
            resample(volume, samples, texels, {}, {.threads = 4}).grid.values);
}

TEST_P(Shepard, TakesTheSettingsOfTheThesis) {
  const Volume volume = ramp_volume({4, 4, 4});
  SampleSet samples;
  add_sample(samples, volume, {0.5, 0.5, 1.0}, {1.0f});
  add_sample(samples, volume, {0.5, 2.5, 0.5}, {4.0f});
  const ResampledGrid result = resample(volume, samples, cell_lattice(volume.lattice()),
                                        {{"k", "11"}, {"exponent", "0.5"}, {"distance", "chebyshev"}});
  // At the first texel the distances are .5 and 2, so the weights are as 2 to 1.
  EXPECT_FLOAT_EQ(result.grid.values[0], 2.0f);
}

TEST_P(Shepard, RefusesWhatItCannotUse) {
  const Volume volume = ramp_volume({4, 4, 4});
  const Lattice texels = cell_lattice(volume.lattice());
  SampleSet samples;
  EXPECT_THROW((void)resample(volume, samples, texels, {}), InvalidInput);
  add_sample(samples, volume, Vec3(1.0), {1.0f});
  EXPECT_THROW((void)resample(volume, samples, texels, {{"k", "0"}}), InvalidInput);
  samples.radiance[0] = std::nanf("");
  EXPECT_THROW((void)resample(volume, samples, texels, {}), InvalidInput);
}

TEST_P(Shepard, StopsWhenAsked) {
  const Volume volume = ramp_volume({4, 4, 4});
  SampleSet samples;
  add_sample(samples, volume, Vec3(1.0), {1.0f});
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)resample(volume, samples, cell_lattice(volume.lattice()), {}, {.stop = stop.get_token()}),
               Cancelled);
}

}  // namespace
}  // namespace isolux
