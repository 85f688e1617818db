// What every resampler of the catalogue promises by its header, besides its light.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/resample.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stop_token>
#include <thread>
#include <vector>

#include "every_resampler.h"

namespace isolux {
namespace {

using testing::at_texel_centres;
using testing::expect_same;
using testing::in_words;
using testing::settings_to_try;
using testing::smooth_light;

class ResamplerContract : public testing::EveryResampler {};
ISOLUX_FOR_EVERY_RESAMPLER(ResamplerContract);

/// A grid over `texels` whose lit ones have values, with all that LightReader wants.
void expect_complete(const ResampledGrid& result, const Lattice& texels, int channels) {
  const IlluminationGrid& grid = result.grid;
  EXPECT_EQ(grid.lattice.size, texels.size);
  EXPECT_EQ(grid.lattice.frame.origin, texels.frame.origin);
  EXPECT_EQ(grid.lattice.frame.axes, texels.frame.axes);
  EXPECT_EQ(grid.channels, channels);
  ASSERT_EQ(grid.values.size(), texels.count() * std::size_t(channels));
  ASSERT_EQ(result.lit.size(), texels.count());
  EXPECT_LE(*std::max_element(result.lit.begin(), result.lit.end()), 1);
  for (std::size_t v = 0; v < grid.values.size(); ++v)
    ASSERT_TRUE(result.lit[v / std::size_t(channels)] == 0 || std::isfinite(grid.values[v])) << v;
  const LightDetail& detail = grid.detail;
  EXPECT_EQ(detail.slopes.size(), detail.slopes.empty() ? 0 : grid.values.size());
  for (const std::vector<float>& slopes : detail.normal_slopes)
    EXPECT_EQ(slopes.size(), detail.normal_slopes[0].empty() ? 0 : grid.values.size());
}

TEST_P(ResamplerContract, GivesTheGridThatWasAskedFor) {
  const Lattice box = volume_.lattice();
  for (const Lattice& texels : {cell_lattice(box), cell_lattice(box, {13, 3, 6}), cell_lattice(box, {1, 6, 5}),
                                cell_lattice(box, {1, 1, 1}), voxel_lattice(box)}) {
    for (const int channels : {1, 3})
      for (const SampleSet& set : samples(volume_, texels, channels))
        expect_complete(resample(volume_, set, texels), texels, channels);
  }
}

TEST_P(ResamplerContract, HasNearFieldTermsOnlyIfItSaysSo) {
  for_each(1, [&](const SampleSet& set, const Settings& settings) {
    const bool has_terms = !resample(volume_, set, texels_, settings).grid.detail.near_field.empty();
    EXPECT_TRUE(!has_terms || resampler(settings)->has_near_field());
  });
}

TEST_P(ResamplerContract, LightsTexelsThatHaveASampleAtTheirCentre) {
  for (const Settings& settings : settings_to_try(GetParam())) {
    const ResampledGrid result =
        resample(volume_, at_texel_centres(volume_, texels_, 1, smooth_light), texels_, settings);
    EXPECT_EQ(std::count(result.lit.begin(), result.lit.end(), 0), 0) << in_words(settings);
  }
}

TEST_P(ResamplerContract, GivesTheSameBitsForAnyNumberOfThreads) {
  const Lattice many = cell_lattice(volume_.lattice(), {11, 10, 10});  // some blocks of those that threads take
  for (const SampleSet& set : samples(volume_, many, 3)) {
    const ResampledGrid one = resample(volume_, set, many, {}, {.threads = 1});
    for (const int threads : {2, 5}) expect_same(one, resample(volume_, set, many, {}, {.threads = threads}));
  }
}

TEST_P(ResamplerContract, GivesTheSameBitsEachTime) {
  for_each(3, [&](const SampleSet& set, const Settings& settings) {
    expect_same(resample(volume_, set, texels_, settings), resample(volume_, set, texels_, settings));
  });
}

TEST_P(ResamplerContract, ServesManyThreadsAndOtherSamplesBetween) {
  const std::unique_ptr<Resampler> shared = resampler();
  const SampleSet other = at_texel_centres(volume_, texels_, 1, [](const Vec3& p, int) { return float(p.y); });
  for (const SampleSet& set : samples(volume_, texels_, 1)) {
    const ResampledGrid alone = resampler()->resample(volume_, set, texels_, {});
    std::vector<ResampledGrid> results(4);
    {
      std::vector<std::jthread> threads;
      for (ResampledGrid& own : results) {
        threads.emplace_back([&] {
          (void)shared->resample(volume_, other, texels_, {});
          own = shared->resample(volume_, set, texels_, {});
        });
      }
    }
    for (const ResampledGrid& own : results) expect_same(alone, own);
  }
}

TEST_P(ResamplerContract, StopsWhenAskedAndServesAfterwards) {
  std::stop_source stop;
  stop.request_stop();
  const isolux::Run stopped{.stop = stop.get_token()};
  for_each(1, [&](const SampleSet& set, const Settings& settings) {
    const std::unique_ptr<Resampler> made = resampler(settings);
    EXPECT_THROW((void)made->resample(volume_, set, texels_, stopped), Cancelled);
    if (made->takes_parts()) {
      IlluminationGrid grid = unlit_grid(texels_, 1);
      EXPECT_THROW(made->add_part(volume_, set, grid, stopped), Cancelled);
    }
    expect_same(made->resample(volume_, set, texels_, {}), resampler(settings)->resample(volume_, set, texels_, {}));
  });
}

TEST_P(ResamplerContract, RefusesSamplesThatDoNotSuit) {
  const SampleSet good = at_texel_centres(volume_, texels_, 3, smooth_light);
  const auto refuses = [&](const std::function<void(SampleSet&)>& spoil) {
    SampleSet bad = good;
    spoil(bad);
    EXPECT_THROW((void)resampler()->resample(volume_, bad, texels_, {}), InvalidInput);
  };
  refuses([](SampleSet& bad) { bad = {}; });
  refuses([](SampleSet& bad) { bad.radiance.pop_back(); });
  refuses([](SampleSet& bad) { bad.variance.pop_back(); });
  refuses([](SampleSet& bad) { bad.sites.isovalues.pop_back(); });
  refuses([](SampleSet& bad) { bad.sites.normals.pop_back(); });
  refuses([](SampleSet& bad) { bad.channels = 2; });
  refuses([](SampleSet& bad) { bad.radiance[4] = std::nanf(""); });
  refuses([](SampleSet& bad) { bad.radiance[5] = INFINITY; });
  refuses([](SampleSet& bad) { bad.lamps = {1.0f, 2.0f}; });
  refuses([](SampleSet& bad) { bad.lamps_variance = {1.0f}; });
  for (const float bad_number : {std::nanf(""), INFINITY, -INFINITY}) {
    refuses([=](SampleSet& bad) { bad.sites.positions[2].y = bad_number; });
    refuses([=](SampleSet& bad) { bad.sites.isovalues[2] = bad_number; });
    refuses([=](SampleSet& bad) { bad.sites.normals[2].z = bad_number; });
    refuses([=](SampleSet& bad) { bad.variance[2] = bad_number; });
  }
  SampleSet unknown = good;
  unknown.variance.assign(unknown.size(), std::numeric_limits<float>::max());
  EXPECT_NO_THROW((void)resampler()->resample(volume_, unknown, texels_, {}));
}

TEST_P(ResamplerContract, RefusesGridsWithoutTexels) {
  const SampleSet good = at_texel_centres(volume_, texels_, 1, smooth_light);
  for (const Index3 size : {Index3(0, 3, 3), Index3(-1, 3, 3), Index3(-1, -1, 3)}) {
    Lattice none = texels_;
    none.size = size;
    EXPECT_THROW((void)resampler()->resample(volume_, good, none, {}), InvalidInput);
  }
  Lattice flat = texels_;
  flat.frame.axes[1] = flat.frame.axes[0];
  EXPECT_THROW((void)resampler()->resample(volume_, good, flat, {}), InvalidInput);
}

TEST_P(ResamplerContract, RefusesPartsForAnotherLight) {
  const std::unique_ptr<Resampler> made = resampler();
  if (!made->takes_parts()) return;
  const SampleSet good = at_texel_centres(volume_, texels_, 3, smooth_light);
  IlluminationGrid grey = unlit_grid(texels_, 1);
  EXPECT_THROW(made->add_part(volume_, good, grey, {}), InvalidInput);
  IlluminationGrid few = unlit_grid(texels_, 3);
  few.values.resize(3);
  EXPECT_THROW(made->add_part(volume_, good, few, {}), InvalidInput);
}

TEST_P(ResamplerContract, LooksAtLampsOnlyIfItSaysSo) {
  for_each(1, [&](const SampleSet& set, const Settings& settings) {
    SampleSet told = set;
    for (const float e : set.radiance) told.lamps.push_back(0.5f * e);
    told.lamps_variance.assign(set.size(), 0.0f);
    const ResampledGrid result = resample(volume_, told, texels_, settings);
    if (resampler(settings)->lamps() == LampLight::kWithin)
      expect_same(result, resample(volume_, set, texels_, settings));
  });
}

/// Of the samples those at every third texel from `first` on, without what parts may lack.
SampleSet third_of(const SampleSet& all, std::size_t first, const Lattice& texels) {
  SampleSet part;
  part.channels = all.channels;
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (s % texels.count() % 3 != first) continue;
    part.sites.positions.push_back(all.sites.positions[s]);
    for (std::size_t c = 0; c < std::size_t(all.channels); ++c)
      part.radiance.push_back(all.radiance[s * std::size_t(all.channels) + c]);
  }
  return part;
}

TEST_P(ResamplerContract, MakesOfPartsWhatItMakesOfAll) {
  // Two samples at each texel but the last.
  SampleSet all = at_texel_centres(volume_, texels_, 3, smooth_light);
  const SampleSet again = at_texel_centres(volume_, texels_, 3, [](const Vec3& p, int c) { return float(p.x) + c; });
  for (std::size_t t = 0; t + 1 < texels_.count(); ++t)
    testing::add_sample(all, volume_, Vec3(again.sites.positions[t]),
                        {again.radiance[3 * t], again.radiance[3 * t + 1], again.radiance[3 * t + 2]});
  for (const Settings& settings : settings_to_try(GetParam())) {
    const std::unique_ptr<Resampler> made = resampler(settings);
    if (!made->takes_parts()) continue;
    IlluminationGrid grid = unlit_grid(texels_, 3);
    for (const std::size_t first : {2u, 0u, 1u}) made->add_part(volume_, third_of(all, first, texels_), grid, {});
    SCOPED_TRACE(in_words(settings));
    expect_same(told_by_bytes(std::move(grid)), made->resample(volume_, all, texels_, {}));
  }
}

TEST_P(ResamplerContract, TakesItsDefaultsAsItListsThem) {
  const Registry<Resampler> registry = resamplers();
  const SampleSet set = at_texel_centres(volume_, texels_, 1, smooth_light);
  Settings listed;
  for (const OptionInfo& option : registry.info(GetParam()).options) listed[option.name] = option.default_value;
  expect_same(resample(volume_, set, texels_, listed), resample(volume_, set, texels_));
}

}  // namespace
}  // namespace isolux
