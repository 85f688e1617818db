#include "texel_near_field.h"

#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/resample.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "near_field.h"
#include "support.h"

namespace isolux {
namespace {

using testing::add_sample;
using testing::make_volume;
using testing::random_samples;

/// Waves of a few grid spacings: walls at all distances.
Volume walls(double sign = 1.0) {
  return make_volume({18, 16, 15}, {1.0, 0.8, 1.3}, [=](const Vec3& p) {
    return sign * (std::sin(0.9 * p.x) + 0.8 * std::cos(0.8 * p.y + 0.3 * p.z) + 0.5 * std::sin(1.1 * p.z));
  });
}

/// Light that the near field explains wholly, by channel.
struct Explained {
  NearField near_field;
  double sign = 1.0;
  std::array<Vec3, 3> weight{Vec3(0.2, 0.1, 0.05), Vec3(-0.1, 0.3, 0.0), Vec3(0.0)};

  [[nodiscard]] float at(const Vec3& index, int channel) const {
    const NearField::Ahead ahead = near_field.ahead(index);
    const double h = near_field.field().value(index);
    const std::array<double, 3> steps{1.0, 2.0, 4.0};
    double e = 0.5;
    for (int s = 0; s < 3; ++s)
      e += weight[std::size_t(channel)][s] * double(near_field.openness(index, ahead, h, sign * steps[std::size_t(s)]));
    return float(e);
  }
};

SampleSet at_texels(const Volume& volume, const Lattice& texels, int channels, const testing::Light& light,
                    OuterSide outer = OuterSide::kLower) {
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  SampleSet set;
  for (int k = 0; k < texels.size.z; ++k)
    for (int j = 0; j < texels.size.y; ++j)
      for (int i = 0; i < texels.size.x; ++i) {
        const Vec3 p(Vec3f(to_volume.world(Vec3(i, j, k))));
        std::vector<float> e;
        for (int c = 0; c < channels; ++c) e.push_back(light(p, c));
        add_sample(set, volume, p, e);
      }
  if (outer == OuterSide::kHigher)
    for (Vec3f& normal : set.sites.normals) normal = -normal;
  return set;
}

IlluminationGrid baked(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                       const Settings& settings = {}, const isolux::Run& run = {}) {
  const auto direct = resamplers().create("direct", settings);
  ResampledGrid grid = direct->resample(volume, samples, texels, run);
  direct->add_detail(volume, samples, grid, run);
  return fill_unlit(std::move(grid), run);
}

IlluminationGrid without_terms(IlluminationGrid light) {
  light.detail = {};
  return light;
}

double reading_error(const Volume& volume, const IlluminationGrid& light, const testing::Light& truth, int channel) {
  const SampleSet at = random_samples(volume, 500, 1, truth, 7);
  const LightReader reader(volume, light);
  double squares = 0.0;
  for (const Vec3f& p : at.sites.positions) {
    const double off = double(reader.at_index(Vec3(p))[channel]) - double(truth(Vec3(p), channel));
    squares += off * off;
  }
  return std::sqrt(squares / double(at.size()));
}

// The ridge pulls weights by parts in a million. Without the terms the same texels are .03 wrong.
TEST(TexelNearField, ReadsLightThatItExplainsExactly) {
  const Volume volume = walls();
  const Lattice texels = cell_lattice(volume.lattice());
  const Explained explained{NearField(volume)};
  const auto truth = [&](const Vec3& p, int c) { return explained.at(p, c); };
  const IlluminationGrid light = baked(volume, at_texels(volume, texels, 3, truth), texels);
  ASSERT_EQ(light.detail.near_field.size(), 3U);
  EXPECT_EQ(light.detail.texel_light, TexelLight::kOwn);
  for (int c = 0; c < 3; ++c)
    for (int s = 0; s < 3; ++s)
      EXPECT_NEAR(light.detail.near_field[std::size_t(s)].weight[c], explained.weight[std::size_t(c)][s], 1e-4);
  for (int c = 0; c < 2; ++c) {
    EXPECT_LT(reading_error(volume, light, truth, c), 1e-4);
    EXPECT_GT(reading_error(volume, without_terms(light), truth, c), 0.03);
  }
}

// Openness says nothing of the first channel's constant; the others' weights are found all the same.
TEST(TexelNearField, ExplainsEachChannelByItself) {
  const Volume volume = walls();
  const Lattice texels = cell_lattice(volume.lattice());
  const Explained explained{NearField(volume)};
  const auto truth = [&](const Vec3& p, int c) { return c == 0 ? 0.25f : explained.at(p, c - 1); };
  const IlluminationGrid light = baked(volume, at_texels(volume, texels, 3, truth), texels);
  ASSERT_EQ(light.detail.near_field.size(), 3U);
  for (int s = 0; s < 3; ++s) {
    const Vec3f& weight = light.detail.near_field[std::size_t(s)].weight;
    EXPECT_EQ(weight.x, 0.0f);
    EXPECT_NEAR(weight.y, explained.weight[0][s], 1e-4);
    EXPECT_NEAR(weight.z, explained.weight[1][s], 1e-4);
  }
}

// Reading adds what loading took off. Sites are texel centres rounded to float, 1e-6 grid spacings off, where light and
// openness change by 3 a spacing.
TEST(TexelNearField, ReadsTexelsAsTheyAre) {
  const Volume volume = walls();
  for (const Index3 size : {Index3(17, 15, 14), Index3(9, 20, 7), Index3(30, 6, 1)}) {
    for (const int channels : {1, 3}) {
      const Lattice texels = cell_lattice(volume.lattice(), size);
      const SampleSet samples = at_texels(volume, texels, channels, [](const Vec3& p, int c) {
        return float(0.5 + 0.4 * std::sin(9.0 * p.x + 7.0 * p.y + 5.0 * p.z + c));
      });
      IlluminationGrid light = baked(volume, samples, texels);
      light.detail.near_field = {{.step = 1.0f, .mean = 0.8f, .weight = {0.3f, -0.2f, 0.1f}},
                                 {.step = -2.0f, .mean = 0.7f, .weight = {0.1f, 0.2f, -0.3f}}};
      light.detail.texel_light = TexelLight::kOwn;
      light.detail.ceiling = 1.0f;
      const LightReader reader(volume, light);
      for (std::size_t s = 0; s < samples.size(); ++s) {
        const Vec3f e = reader.at_index(Vec3(samples.sites.positions[s]));
        for (int c = 0; c < channels; ++c)
          ASSERT_NEAR(e[c], samples.radiance[s * std::size_t(channels) + std::size_t(c)], 1e-5);
      }
    }
  }
}

// Neither constants nor ramps differ from the mean of opposite neighbours by more than rounding; noise does, but
// openness foretells none of it. Then light is read as if there were no near field.
TEST(TexelNearField, LeavesLightAloneThatOpennessSaysNothingOf) {
  const Volume volume = walls();
  const Lattice texels = cell_lattice(volume.lattice());
  const std::vector<testing::Light> lights{
      [](const Vec3&, int) { return 0.7f; }, [](const Vec3& p, int) { return float(0.1 + 0.03 * p.x + 0.01 * p.y); },
      [](const Vec3& p, int) {
        RandomStream random(3, std::uint64_t(p.x) + 100 * std::uint64_t(p.y) + 10000 * std::uint64_t(p.z));
        return random.uniform_float();
      }};
  for (const testing::Light& light : lights)
    EXPECT_TRUE(baked(volume, at_texels(volume, texels, 1, light), texels).detail.empty());
}

// One seed's noise of .1 puts a weight off by some .04 (openness at several steps is much alike), the mean of 256 by
// .0025; a bias would stay.
TEST(TexelNearField, IsNotBiasedByNoise) {
  const Volume volume = walls();
  const Lattice texels = cell_lattice(volume.lattice());
  const Explained explained{NearField(volume)};
  Vec3 sum(0.0);
  for (std::uint64_t seed = 0; seed < 256; ++seed) {
    SampleSet samples = at_texels(volume, texels, 1, [&](const Vec3& p, int c) { return explained.at(p, c); });
    for (std::size_t s = 0; s < samples.size(); ++s) {
      RandomStream random(seed, s);
      samples.radiance[s] += 0.1f * std::sqrt(12.0f) * (random.uniform_float() - 0.5f);
    }
    const IlluminationGrid light = baked(volume, samples, texels);
    ASSERT_EQ(light.detail.near_field.size(), 3U);
    for (int s = 0; s < 3; ++s) sum[s] += double(light.detail.near_field[std::size_t(s)].weight.x);
  }
  for (int s = 0; s < 3; ++s) EXPECT_NEAR(sum[s] / 256.0, explained.weight[0][s], 0.008);
}

TEST(TexelNearField, StepsTowardsTheOuterSide) {
  const Volume lower = walls();
  const Volume higher = walls(-1.0);
  const Lattice texels = cell_lattice(lower.lattice());
  const Explained explained{NearField(lower)};
  const auto truth = [&](const Vec3& p, int c) { return explained.at(p, c); };
  const SampleSet samples = at_texels(higher, texels, 1, truth, OuterSide::kHigher);
  const IlluminationGrid one = baked(lower, at_texels(lower, texels, 1, truth), texels);
  const IlluminationGrid other = baked(higher, samples, texels);
  ASSERT_EQ(other.detail.near_field.size(), 3U);
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_EQ(other.detail.near_field[s].step, -one.detail.near_field[s].step);
    EXPECT_EQ(other.detail.near_field[s].weight, one.detail.near_field[s].weight);
  }
}

// Their light is that of neighbours, with the near field of those in it.
TEST(TexelNearField, LeavesTexelsThatCannotBeLit) {
  const Volume volume =
      make_volume({24, 12, 12}, Vec3(1.0), [](const Vec3& p) { return std::max(0.0, std::sin(p.x)); });
  const TrilinearField field(volume);
  for (const ValueRange& range : {ValueRange{.low = 0.3f, .high = 0.8f}, value_range(volume)}) {
    IlluminationGrid light(cell_lattice(volume.lattice()), 1);
    std::fill(light.values.begin(), light.values.end(), 0.5f);
    light.detail.near_field = {{.step = 1.0f, .mean = -3.0f, .weight = Vec3f(0.2f)}};  // openness is never as small
    light.detail.texel_light = TexelLight::kOwn;
    if (range.low > 0.0f) light.detail.isovalues = range;
    const LightReader reader(volume, light);
    const IndexToWorld to_volume = index_to_index(light.lattice, volume.lattice());
    std::size_t left = 0;
    for (int i = 0; i < light.lattice.size.x; ++i) {
      const Vec3 p = to_volume.world(Vec3(i, 5, 5));
      // Read from it are level sets between the texels before and behind it.
      double least = 2.0;
      double largest = -1.0;
      for (int x = i == 0 ? 0 : i - 1; x <= i + 2; ++x) {
        const double h = field.value({std::min(x, 23), p.y, p.z});
        least = std::min(least, h);
        largest = std::max(largest, h);
      }
      const bool lit = largest >= double(range.low) && least <= double(range.high) && !field.is_flat_around(p);
      left += lit ? 0 : 1;
      EXPECT_EQ(reader.offsets().values[light.lattice.offset(i, 5, 5)] == 0.5f, !lit) << i;
    }
    EXPECT_GT(left, 4U);
  }
}

TEST(TexelNearField, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Volume volume = walls();
  const Lattice texels = cell_lattice(volume.lattice());
  const Explained explained{NearField(volume)};
  const SampleSet samples = at_texels(volume, texels, 3, [&](const Vec3& p, int c) { return explained.at(p, c); });
  const IlluminationGrid one = baked(volume, samples, texels, {}, {.threads = 1});
  const IlluminationGrid four = baked(volume, samples, texels, {}, {.threads = 4});
  ASSERT_EQ(one.detail.near_field.size(), four.detail.near_field.size());
  for (std::size_t s = 0; s < one.detail.near_field.size(); ++s) {
    EXPECT_EQ(one.detail.near_field[s].mean, four.detail.near_field[s].mean);
    EXPECT_EQ(one.detail.near_field[s].weight, four.detail.near_field[s].weight);
  }
  EXPECT_EQ(LightReader(volume, one, TexelStorage::kDense, {.threads = 1}).offsets().values,
            LightReader(volume, one, TexelStorage::kDense, {.threads = 4}).offsets().values);
}

TEST(TexelNearField, IsLeftOutOnRequest) {
  const Volume volume = walls();
  const Lattice texels = cell_lattice(volume.lattice());
  const Explained explained{NearField(volume)};
  const SampleSet samples = at_texels(volume, texels, 1, [&](const Vec3& p, int c) { return explained.at(p, c); });
  const IlluminationGrid with = baked(volume, samples, texels);
  const IlluminationGrid without = baked(volume, samples, texels, {{"near_field", "false"}});
  EXPECT_FALSE(with.detail.empty());
  EXPECT_TRUE(without.detail.empty());
  EXPECT_EQ(with.values, without.values);  // plain light stays plain
  EXPECT_EQ(with.values, samples.radiance);
}

}  // namespace
}  // namespace isolux
