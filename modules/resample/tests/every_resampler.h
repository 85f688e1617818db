#pragma once

#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/resample.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "support.h"

namespace isolux::testing {

inline std::vector<std::string> resampler_names() {
  std::vector<std::string> names;
  const Registry<Resampler> registry = resamplers();
  for (const BackendInfo& info : registry.backends())
    if (info.unavailable.empty()) names.push_back(info.name);
  return names;
}

/// The defaults, and each switch and each word of a choice that is not its option's default.
inline std::vector<Settings> settings_to_try(const std::string& backend) {
  std::vector<Settings> all{{}};
  const Registry<Resampler> registry = resamplers();
  for (const OptionInfo& option : registry.info(backend).options) {
    const std::vector<std::string> words =
        option.type == "bool" ? std::vector<std::string>{"true", "false"} : option.choices;
    for (const std::string& word : words)
      if (word != option.default_value) all.push_back({{option.name, word}});
  }
  return all;
}

inline std::string in_words(const Settings& settings) {
  std::string words = "defaults";
  for (const auto& [key, value] : settings) words.assign(key).append("=").append(value);
  return words;
}

/// Waves of some nine voxels, in a box that is `turn` from the axes of the world.
inline Volume volume_to_light(const Mat3& turn = Mat3(1.0), const Vec3& origin = Vec3(0.0)) {
  Volume volume = make_volume({7, 6, 5}, {1.0, 0.7, 2.0}, [](const Vec3& p) {
    return std::sin(0.7 * p.x) + 0.8 * std::cos(0.6 * p.y + 0.3 * p.z) + 0.1 * p.z;
  });
  Lattice lattice = volume.lattice();
  lattice.frame = {.origin = origin, .axes = turn * lattice.frame.axes};
  volume.values = Grid<float>(lattice, {volume.values.values().begin(), volume.values.values().end()});
  return volume;
}

/// Smooth light from 1 to 2, another one along each axis and in each channel.
inline float smooth_light(const Vec3& p, int channel) {
  return float(1.5 + 0.3 * std::sin(0.5 * p.x + channel) + 0.15 * std::cos(0.7 * p.y) - 0.02 * (p.z - 2.0));
}

inline SampleSet at_texel_centres(const Volume& volume, const Lattice& texels, int channels, const Light& light) {
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  SampleSet set;
  for (int t = 0; t < int(texels.count()); ++t) {
    const Index3 n = texels.size;
    const Vec3 p(Vec3f(to_volume.world(Vec3(t % n.x, t / n.x % n.y, t / (n.x * n.y)))));
    std::vector<float> radiance;
    for (int c = 0; c < channels; ++c) radiance.push_back(light(p, c));
    add_sample(set, volume, p, radiance, 1e-4f);
  }
  return set;
}

/// Bits of two results, what unlit texels hold left aside.
inline void expect_same(ResampledGrid a, ResampledGrid b) {
  ASSERT_EQ(a.lit, b.lit);
  for (ResampledGrid* result : {&a, &b})
    for (std::size_t v = 0; v < result->grid.values.size(); ++v)
      if (result->lit[v / std::size_t(result->grid.channels)] == 0) result->grid.values[v] = 0.0f;
  EXPECT_EQ(a.grid.values, b.grid.values);
  const LightDetail& one = a.grid.detail;
  const LightDetail& other = b.grid.detail;
  EXPECT_EQ(one.slopes, other.slopes);
  EXPECT_EQ(one.normal_slopes, other.normal_slopes);
  EXPECT_EQ(one.ceiling, other.ceiling);
  ASSERT_EQ(one.near_field.size(), other.near_field.size());
  for (std::size_t t = 0; t < one.near_field.size(); ++t) {
    EXPECT_EQ(one.near_field[t].step, other.near_field[t].step);
    EXPECT_EQ(one.near_field[t].mean, other.near_field[t].mean);
    EXPECT_EQ(one.near_field[t].weight, other.near_field[t].weight);
  }
}

/// A test that runs for every backend of the catalogue, by name.
class EveryResampler : public ::testing::TestWithParam<std::string> {
 protected:
  /// Scattered samples suit most backends; one that refuses them is held to its promises with samples at the texels'
  /// centres alone, which suit all.
  void SetUp() override {  // NOLINT(readability-identifier-naming): GoogleTest's name
    const Volume volume = volume_to_light();
    try {
      (void)resample(volume, random_samples(volume, 50, 1, smooth_light), cell_lattice(volume.lattice()));
    } catch (const InvalidInput&) {
      takes_scattered_ = false;
    }
  }

  [[nodiscard]] std::vector<SampleSet> samples(const Volume& volume, const Lattice& texels, int channels,
                                               const Light& light = smooth_light) const {
    std::vector<SampleSet> sets{at_texel_centres(volume, texels, channels, light)};
    if (takes_scattered_) sets.push_back(random_samples(volume, 1000, channels, light));  // 8 a cell
    return sets;
  }

  [[nodiscard]] static std::unique_ptr<Resampler> resampler(const Settings& settings = {}) {
    return resamplers().create(GetParam(), settings);
  }
  static ResampledGrid resample(const Volume& volume, const SampleSet& set, const Lattice& texels,
                                const Settings& settings = {}, const isolux::Run& run = {}) {
    const std::unique_ptr<Resampler> made = resampler(settings);
    ResampledGrid result = made->resample(volume, set, texels, run);
    made->add_detail(volume, set, result, run);
    return result;
  }
  /// What is read at the texels' centres, as a bake gives it on.
  static std::vector<float> light_at_texels(const Volume& volume, const SampleSet& set, const Lattice& texels,
                                            const Settings& settings = {}) {
    const IlluminationGrid light = fill_unlit(resample(volume, set, texels, settings), {});
    const LightReader reader(volume, light);
    std::vector<float> read;
    const SampleSet centres = at_texel_centres(volume, texels, 1, smooth_light);
    for (const Vec3f& p : centres.sites.positions)
      for (int c = 0; c < set.channels; ++c) read.push_back(reader.at_index(Vec3(p))[c]);
    return read;
  }

  /// Calls `test` with each kind of samples under each of the settings.
  void for_each(int channels, const std::function<void(const SampleSet&, const Settings&)>& test) const {
    for (const Settings& settings : settings_to_try(GetParam())) {
      SCOPED_TRACE(in_words(settings));
      for (const SampleSet& set : samples(volume_, texels_, channels)) test(set, settings);
    }
  }

  const Volume volume_ = volume_to_light();
  const Lattice texels_ = cell_lattice(volume_.lattice(), {8, 4, 5});
  bool takes_scattered_ = true;
};

#define ISOLUX_FOR_EVERY_RESAMPLER(suite)                                                     \
  INSTANTIATE_TEST_SUITE_P(Catalogue, suite, ::testing::ValuesIn(testing::resampler_names()), \
                           [](const auto& backend) { return backend.param; })

}  // namespace isolux::testing
