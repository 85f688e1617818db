// What the light of every resampler of the catalogue must be, whatever its method.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/resample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "every_resampler.h"

namespace isolux {
namespace {

using testing::at_texel_centres;
using testing::in_words;
using testing::settings_to_try;
using testing::smooth_light;
using testing::volume_to_light;

class ResamplerLight : public testing::EveryResampler {};
ISOLUX_FOR_EVERY_RESAMPLER(ResamplerLight);

TEST_P(ResamplerLight, ReproducesConstants) {
  const auto constant = [](const Vec3&, int c) { return 0.7f + float(c); };
  for (const Settings& settings : settings_to_try(GetParam())) {
    for (const SampleSet& set : samples(volume_, texels_, 3, constant)) {
      const std::vector<float> light = light_at_texels(volume_, set, texels_, settings);
      // Means of up to some hundred samples, and sums of eight weights that are one to rounding.
      for (std::size_t v = 0; v < light.size(); ++v) ASSERT_NEAR(light[v], 0.7f + float(v % 3), 1e-5f);
    }
  }
}

// The weakest claim that tells resampling from anything else: what is left is a third of how light differs from its
// mean, for samples as dense as the texels and denser.
TEST_P(ResamplerLight, FollowsTheLight) {
  const SampleSet truth = at_texel_centres(volume_, texels_, 3, smooth_light);
  std::array<double, 3> mean{};
  for (std::size_t v = 0; v < truth.radiance.size(); ++v)
    mean[v % 3] += double(truth.radiance[v]) / double(truth.size());
  for_each(3, [&](const SampleSet& set, const Settings& settings) {
    const std::vector<float> light = light_at_texels(volume_, set, texels_, settings);
    std::array<double, 3> wrong{};
    std::array<double, 3> spread{};
    for (std::size_t v = 0; v < light.size(); ++v) {
      wrong[v % 3] += std::pow(double(light[v]) - double(truth.radiance[v]), 2.0);
      spread[v % 3] += std::pow(mean[v % 3] - double(truth.radiance[v]), 2.0);
    }
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(std::sqrt(wrong[c]), std::sqrt(spread[c]) / 3.0) << c;
  });
}

// A fit may overshoot; by more than half of what all samples differ by none should.
TEST_P(ResamplerLight, StaysNearItsSamples) {
  for_each(1, [&](const SampleSet& set, const Settings& settings) {
    const auto [low, high] = std::minmax_element(set.radiance.begin(), set.radiance.end());
    const float margin = 0.5f * (*high - *low);
    for (const float e : light_at_texels(volume_, set, texels_, settings)) {
      ASSERT_GE(e, *low - margin);
      ASSERT_LE(e, *high + margin);
    }
  });
}

/// Few samples, or many that do not span the box, all at texel centres.
std::vector<SampleSet> few_samples(const Volume& volume, const Lattice& texels) {
  const SampleSet all = at_texel_centres(volume, texels, 1, smooth_light);
  const auto chosen = [&](const std::vector<Index3>& places) {
    SampleSet set;
    for (const Index3& i : places) {
      const std::size_t t = texels.offset(i.x, i.y, i.z);
      testing::add_sample(set, volume, Vec3(all.sites.positions[t]), {all.radiance[t]});
    }
    return set;
  };
  std::vector<Index3> line;
  std::vector<Index3> plane;
  for (int i = 0; i < texels.size.x; ++i) {
    line.emplace_back(i, 2, 1);
    for (int j = 0; j < texels.size.y; ++j) plane.emplace_back(i, j, 3);
  }
  return {chosen({{4, 3, 2}}), chosen({{0, 0, 0}, {7, 3, 4}}), chosen({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), chosen(line),
          chosen(plane)};
}

TEST_P(ResamplerLight, StandsFewSamplesAndSamplesOnAPlane) {
  for (const Settings& settings : settings_to_try(GetParam())) {
    SCOPED_TRACE(in_words(settings));
    for (const SampleSet& set : few_samples(volume_, texels_)) {
      const ResampledGrid result = resample(volume_, set, texels_, settings);
      EXPECT_GT(std::count(result.lit.begin(), result.lit.end(), 1), 0) << set.size();
      const auto [low, high] = std::minmax_element(set.radiance.begin(), set.radiance.end());
      // Beyond the samples a slope may go on: as far again as they differ. A single value is reproduced to rounding.
      const float margin = *high - *low + 1e-5f;
      for (const float e : light_at_texels(volume_, set, texels_, settings)) {
        ASSERT_GE(e, *low - margin) << set.size();
        ASSERT_LE(e, *high + margin) << set.size();
      }
    }
  }
}

// Distances are lengths along the box's axes: where the box lies and how it is turned is all one, to what rounding
// makes of the choice among equally near samples.
TEST_P(ResamplerLight, DoesNotDependOnWhereTheBoxLies) {
  const Mat3 turn(glm::rotate(glm::dmat4(1.0), 0.7, Vec3(1.0, 2.0, -0.5)));
  const Volume moved = volume_to_light(turn, {30.0, -20.0, 10.0});
  const Lattice moved_texels = cell_lattice(moved.lattice(), texels_.size);
  const std::vector<SampleSet> sets = samples(volume_, texels_, 3);
  const std::vector<SampleSet> moved_sets = samples(moved, moved_texels, 3);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const std::vector<float> light = light_at_texels(volume_, sets[i], texels_);
    const std::vector<float> moved_light = light_at_texels(moved, moved_sets[i], moved_texels);
    for (std::size_t v = 0; v < light.size(); ++v) ASSERT_NEAR(moved_light[v], light[v], 1e-4f) << v;
  }
}

}  // namespace
}  // namespace isolux
