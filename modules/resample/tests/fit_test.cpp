#include <gtest/gtest.h>
#include <isolux/resample.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "support.h"

namespace isolux {
namespace {

using testing::add_sample;
using testing::make_volume;
using testing::ramp_volume;
using testing::random_samples;
using testing::wavy_volume;

ResampledGrid fitted(const Volume& volume, const SampleSet& samples, const Lattice& texels, Settings settings = {},
                     const isolux::Run& run = {}) {
  return resamplers().create("fit", settings)->resample(volume, samples, texels, run);
}

/// Root mean square of what is read at other samples less what they are.
double reading_error(const Volume& volume, const IlluminationGrid& light, const SampleSet& at) {
  const LightReader reader(volume, light);
  double squares = 0.0;
  for (std::size_t s = 0; s < at.size(); ++s) {
    const Vec3f e = reader.at_index(Vec3(at.sites.positions[s]));
    for (int c = 0; c < at.channels; ++c) {
      const double d = double(e[c]) - double(at.radiance[s * std::size_t(at.channels) + std::size_t(c)]);
      squares += d * d;
    }
  }
  return std::sqrt(squares / double(at.radiance.size()));
}

// To rounding: the eight float weights of a reading add up to one within 1e-7 or so.
TEST(Fit, ReproducesConstants) {
  const Volume volume = wavy_volume();
  for (const int channels : {1, 3}) {
    const SampleSet samples =
        random_samples(volume, 4000, channels, [](const Vec3&, int c) { return 0.4f + float(c); });
    const SampleSet others = random_samples(
        volume, 100, channels, [](const Vec3&, int c) { return 0.4f + float(c); }, 2);
    const ResampledGrid result = fitted(volume, samples, cell_lattice(volume.lattice()));
    EXPECT_LT(reading_error(volume, fill_unlit(result, {}), others), 1e-6);
  }
}

// Light linear in space is in the reach of trilinear texels, up to what the priors (3 percent of a sample) pull.
TEST(Fit, ReproducesALinearRamp) {
  const Volume volume = wavy_volume();
  const auto ramp = [](const Vec3& p, int c) { return float(2.0 + 0.1 * p.x - 0.05 * p.y + 0.02 * p.z * (1 + c)); };
  const Lattice texels = cell_lattice(volume.lattice());
  const IlluminationGrid light = fill_unlit(fitted(volume, random_samples(volume, 12000, 3, ramp), texels), {});
  SampleSet inside;
  for (const Vec3 p : {Vec3(3.1, 4.2, 5.3), Vec3(6.7, 2.9, 1.4), Vec3(8.5, 7.5, 6.5)})
    add_sample(inside, volume, p, {ramp(p, 0), ramp(p, 1), ramp(p, 2)});
  EXPECT_LT(reading_error(volume, light, inside), 0.01);
}

// A wall of one and a half voxels, bright on one side and dark on the other: both sheets lie in neighbouring texels.
// The fit must bleed clearly less than exact light at the texel centres, read trilinearly, does.
TEST(Fit, BleedsLessThroughAThinWallThanTexelsDo) {
  const double middle = 6.2;
  const Volume volume =
      make_volume({13, 9, 9}, Vec3(1.0), [&](const Vec3& p) { return -std::fabs(p.x + 0.1 * p.y - middle); });
  const auto sides = [&](const Vec3& p, int) { return p.x + 0.1 * p.y < middle ? 1.0f : 0.2f; };
  const Lattice texels = cell_lattice(volume.lattice());
  SampleSet centres;
  for (int q = 0; q < 12 * 8 * 8; ++q) {
    const Vec3 p = Vec3(q % 12, q / 12 % 8, q / 96) + 0.5;
    add_sample(centres, volume, p, {sides(p, 0)});
  }
  SampleSet sheets;
  for (int q = 0; q < 400; ++q) {
    RandomStream random(5, std::uint64_t(q));
    const double y = 1.0 + 6.0 * random.uniform_double();
    const double x = middle - 0.1 * y + (q % 2 == 0 ? 0.4 : -0.4);
    const Vec3 p(x, y, 1.0 + 6.0 * random.uniform_double());
    add_sample(sheets, volume, p, {sides(p, 0)});
  }
  const double direct =
      reading_error(volume, resamplers().create("direct")->resample(volume, centres, texels, {}).grid, sheets);
  const SampleSet scattered = random_samples(volume, 12 * 8 * 8 * 8, 1, sides);
  const double fit = reading_error(volume, fill_unlit(fitted(volume, scattered, texels), {}), sheets);
  RecordProperty("direct", std::to_string(direct));
  RecordProperty("fit", std::to_string(fit));
  EXPECT_LT(fit, direct);
}

// Light that is a function of the isovalue, faster than texels can follow: a slope over the isovalue can.
TEST(Fit, FollowsLightThatChangesWithTheIsovalue) {
  const Volume volume =
      make_volume({12, 12, 12}, Vec3(1.0), [](const Vec3& p) { return (int(p.x) % 2 == 0 ? 0.0 : 10.0) + p.y; });
  const TrilinearField field(volume);
  const auto by_value = [&](const Vec3& p, int) { return float(0.05 * field.value(p)); };
  const SampleSet samples = random_samples(volume, 11 * 11 * 11 * 8, 1, by_value);
  const SampleSet others = random_samples(volume, 500, 1, by_value, 2);
  const Lattice texels = cell_lattice(volume.lattice());
  const auto error = [&](const std::string& slopes) {
    return reading_error(
        volume,
        fill_unlit(fitted(volume, samples, texels, {{"slopes", slopes}, {"normals", "false"}, {"near_field", "false"}}),
                   {}),
        others);
  };
  // Half the light's range of .5 alternates from texel to texel.
  EXPECT_GT(error("false"), 0.05);
  EXPECT_LT(error("true"), 0.005);
}

// A tracer gives the largest float to samples of which it knows no variance: of some it says nothing of the others, and
// of all of them that they may be anything, so that texels are means with finite numbers.
TEST(Fit, StandsSamplesOfUnknownVariance) {
  const Volume volume = wavy_volume();
  const TrilinearField field(volume);
  SampleSet samples =
      random_samples(volume, 11 * 9 * 8 * 8, 1, [&](const Vec3& p, int) { return float(1.0 + 0.2 * field.value(p)); });
  const Lattice texels = cell_lattice(volume.lattice());
  const ResampledGrid known = fitted(volume, samples, texels);
  samples.variance[7] = std::numeric_limits<float>::max();
  const ResampledGrid one_unknown = fitted(volume, samples, texels);
  EXPECT_EQ(one_unknown.grid.values, known.grid.values);
  EXPECT_EQ(one_unknown.grid.detail.slopes, known.grid.detail.slopes);
  samples.variance.assign(samples.size(), std::numeric_limits<float>::max());
  const ResampledGrid none_known = fitted(volume, samples, texels);
  for (const float v : none_known.grid.values) EXPECT_TRUE(std::isfinite(v));
  // A texel's prior holds its slopes with 6,000 samples against some 8: to a thousandth of the 0.2 there is.
  for (const float slope : none_known.grid.detail.slopes) EXPECT_NEAR(slope, 0.0f, 2e-3f);
}

// Light by the normal alone, whose normals turn round within a texel or two: three numbers a texel follow it where the
// value and its change with the isovalue cannot. The normal may be that of either side.
TEST(Fit, FollowsLightThatChangesWithTheNormal) {
  const Volume volume = make_volume({14, 12, 11}, {1.0, 0.7, 2.0}, [](const Vec3& p) {
    return std::sin(1.7 * p.x) + std::cos(1.5 * p.y + 0.4 * p.x) + std::sin(1.2 * p.z + p.y);
  });
  const TrilinearField field(volume);
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    const auto by_normal = [&](const Vec3& p, int c) {
      return float(0.5 + 0.4 * field.normal(p, outer, GradientKind::kCentralDifferences)[c]);
    };
    const SampleSet samples = random_samples(volume, 13 * 11 * 10 * 16, 3, by_normal);
    const SampleSet others = random_samples(volume, 1000, 3, by_normal, 2);
    const Lattice texels = cell_lattice(volume.lattice());
    const auto error = [&](const std::string& normals) {
      const Settings settings{{"normals", normals}, {"near_field", "false"}, {"iterations", "60"}};
      return reading_error(volume, fill_unlit(fitted(volume, samples, texels, settings), {}), others);
    };
    // The light's own deviation is .4 / sqrt(3) = .23. With normals it is in reach but for the priors' pull: 3 percent
    // of a sample against some 16 samples of a third each, and a tenth of one on the value, 1 to 2 percent together.
    EXPECT_GT(error("false"), 0.05);
    EXPECT_LT(error("true"), 0.015);
  }
}

/// Mean of what is read at the samples less what they are, weighted, and the mean of its absolute value.
struct MeanError {
  double mean = 0.0;
  double absolute = 0.0;
};

MeanError mean_error(const Volume& volume, const IlluminationGrid& light, const SampleSet& at,
                     const std::vector<double>& weights) {
  const LightReader reader(volume, light);
  MeanError error;
  double total = 0.0;
  for (std::size_t s = 0; s < at.size(); ++s) {
    const double d = double(reader.at_index(Vec3(at.sites.positions[s])).x) - double(at.radiance[s]);
    error.mean += weights[s] * d;
    error.absolute += weights[s] * std::fabs(d);
    total += weights[s];
  }
  return {.mean = error.mean / total, .absolute = error.absolute / total};
}

// Light that is at its bound beside steps finer than texels follow: what a fit overshoots by is clamped when it is
// read, what it falls short by is not. A fit that does not know is too dark by .13 of its mean absolute error here,
// three rounds leave .04.
TEST(Fit, IsNoDarkerWhereLightIsAtItsBound) {
  const Volume volume = wavy_volume();
  const auto light = [](const Vec3& p, int) { return std::sin(1.3 * p.x) * std::cos(1.1 * p.y) > -0.2 ? 1.0f : 0.3f; };
  const SampleSet samples = random_samples(volume, 11 * 9 * 8 * 16, 1, light);
  const IlluminationGrid texels = fill_unlit(fitted(volume, samples, cell_lattice(volume.lattice())), {});
  const MeanError error = mean_error(volume, texels, samples, std::vector<double>(samples.size(), 1.0));
  RecordProperty("mean", std::to_string(error.mean));
  RecordProperty("absolute", std::to_string(error.absolute));
  EXPECT_LT(std::fabs(error.mean), 0.07 * error.absolute);
}

// With next to no prior the normal equations say that errors have no mean by their own weights, the root of the
// steepness, to rounding; evenly weighted they have one, of 2e-3 of their size here. A plain
// grid is not clamped.
TEST(Fit, WeighsSamplesByTheRootOfSteepness) {
  const Volume volume =
      make_volume({10, 9, 8}, Vec3(1.0), [](const Vec3& p) { return std::pow(p.x, 3.0) + 0.5 * p.y * p.z; });
  const auto light = [](const Vec3& p, int) {
    return float(0.5 + 0.2 * std::sin(0.9 * p.x * p.x) + (p.x < 0.05 ? 0.5 : 0.0));
  };
  const SampleSet samples = random_samples(volume, 9 * 8 * 7 * 16, 1, light);
  const Settings settings{{"value_prior", "1e-6"},
                          {"iterations", "60"},
                          {"slopes", "false"},
                          {"normals", "false"},
                          {"near_field", "false"}};
  const IlluminationGrid texels = fill_unlit(fitted(volume, samples, cell_lattice(volume.lattice()), settings), {});
  const TrilinearField field(volume);
  std::vector<double> roots;
  for (const Vec3f& p : samples.sites.positions)
    roots.push_back(std::sqrt(glm::length(field.world_gradient(Vec3(p), GradientKind::kCentralDifferences))));
  const MeanError by_root = mean_error(volume, texels, samples, roots);
  const MeanError evenly = mean_error(volume, texels, samples, std::vector<double>(samples.size(), 1.0));
  EXPECT_LT(std::fabs(by_root.mean), 1e-6 * by_root.absolute);
  EXPECT_GT(std::fabs(evenly.mean), 5e-4 * evenly.absolute);
}

TEST(Fit, AveragesNoiseAway) {
  const Volume volume = wavy_volume();
  std::uint64_t at = 0;
  const auto noisy = [&](const Vec3&, int) { return RandomStream(4, at++).uniform_float(); };
  SampleSet samples = random_samples(volume, 11 * 9 * 8 * 16, 1, noisy);
  samples.variance.assign(samples.size(), 1.0f / 12.0f);
  const SampleSet others = random_samples(
      volume, 500, 1, [](const Vec3&, int) { return 0.5f; }, 2);
  // A sample's standard deviation is .29; a reading sees some 3.4^3 * 16/8 effective samples a texel's tent, hence
  // about .29/sqrt(16 * 27/8) = .04 without the priors' help, twice that near the faces.
  EXPECT_LT(reading_error(volume, fill_unlit(fitted(volume, samples, cell_lattice(volume.lattice())), {}), others),
            0.09);
}

TEST(Fit, LeavesTexelsWithoutSamplesUnlit) {
  const Volume volume = ramp_volume({9, 9, 9});
  SampleSet samples;
  add_sample(samples, volume, Vec3(1.0, 1.0, 1.0), {0.5f});
  const ResampledGrid result = fitted(volume, samples, cell_lattice(volume.lattice()));
  // The sample lies between the centres of the eight texels at the corner.
  EXPECT_EQ(std::count(result.lit.begin(), result.lit.end(), std::uint8_t(1)), 8);
}

TEST(Fit, WorksWithOneTexelAnAxis) {
  const Volume volume = ramp_volume({5, 6, 7});
  for (const Index3 size : {Index3(1, 1, 1), Index3(1, 5, 6), Index3(4, 1, 1), Index3(9, 10, 2)}) {
    const Lattice texels = cell_lattice(volume.lattice(), size);
    const SampleSet samples = random_samples(volume, 900, 1, [](const Vec3&, int) { return 0.75f; });
    for (const float v : fill_unlit(fitted(volume, samples, texels), {}).values) EXPECT_NEAR(v, 0.75f, 1e-6f);
  }
}

TEST(Fit, StaysFiniteOnFlatData) {
  Volume volume = ramp_volume({6, 6, 6});
  for (float& v : volume.values.values()) v = 7.0f;
  volume.values(3, 3, 3) = 8.0f;
  const SampleSet samples = random_samples(volume, 2000, 1, [](const Vec3& p, int) { return p.x > 2.5 ? 1.0f : 0.0f; });
  const IlluminationGrid light = fill_unlit(fitted(volume, samples, cell_lattice(volume.lattice())), {});
  for (const float v : light.values) EXPECT_TRUE(std::isfinite(v));
  for (const float v : light.detail.slopes) EXPECT_TRUE(std::isfinite(v));
  for (const auto& slopes : light.detail.normal_slopes)
    for (const float v : slopes) EXPECT_TRUE(std::isfinite(v));
}

TEST(Fit, IsTheSameForAnyNumberOfThreads) {
  const Volume volume = wavy_volume();
  const SampleSet samples = random_samples(
      volume, 5000, 3, [](const Vec3& p, int c) { return float(0.5 + 0.5 * std::sin(p.x + 2.0 * p.y + c)); });
  const Lattice texels = cell_lattice(volume.lattice());
  const IlluminationGrid one = fitted(volume, samples, texels, {}, {.threads = 1}).grid;
  const IlluminationGrid four = fitted(volume, samples, texels, {}, {.threads = 4}).grid;
  EXPECT_EQ(one.values, four.values);
  EXPECT_EQ(one.detail.slopes, four.detail.slopes);
  EXPECT_FALSE(one.detail.normal_slopes[2].empty());
  EXPECT_EQ(one.detail.normal_slopes, four.detail.normal_slopes);
  for (std::size_t t = 0; t < one.detail.near_field.size(); ++t) {
    EXPECT_EQ(one.detail.near_field[t].weight, four.detail.near_field[t].weight);
  }
}

}  // namespace
}  // namespace isolux
