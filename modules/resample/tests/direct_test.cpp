#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/resample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "support.h"

namespace isolux {
namespace {

using testing::add_sample;
using testing::ramp_volume;

SampleSet one_a_texel(const Volume& volume, const Lattice& texels) {
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  SampleSet set;
  for (int k = 0; k < texels.size.z; ++k)
    for (int j = 0; j < texels.size.y; ++j)
      for (int i = 0; i < texels.size.x; ++i) {
        const auto v = float(texels.offset(i, j, k));
        add_sample(set, volume, to_volume.world(Vec3(i, j, k)), {v, v + 0.25f, v + 0.5f});
      }
  return set;
}

TEST(Direct, PutsEachSampleAtItsTexel) {
  const Volume volume = ramp_volume({5, 6, 7}, {0.5, 1.0, 2.5});
  for (const Index3 size : {Index3(4, 5, 6), Index3(9, 3, 7), Index3(1, 1, 1)}) {
    const Lattice texels = cell_lattice(volume.lattice(), size);
    const SampleSet samples = one_a_texel(volume, texels);
    const ResampledGrid result = resamplers().create("direct")->resample(volume, samples, texels, {});
    EXPECT_EQ(result.grid.values, samples.radiance);
    EXPECT_EQ(result.lit, std::vector<std::uint8_t>(texels.count(), 1));
  }
}

// Trilinear reading of a ramp is the ramp between the outermost texel centres, whatever the ratio of texels to cells is
// and if it is another one an axis; float light of size 3 is rounded to 2e-7.
TEST(Direct, ReproducesRampsAtAnyRatioOfTexelsToCells) {
  const Volume volume = ramp_volume({9, 13, 7}, {0.5, 1.0, 2.5});
  const Vec3 cells(volume.lattice().size - 1);
  const auto ramp = [](const Vec3& p) { return float(0.25 + 0.125 * p.x + 0.0625 * p.y + 0.25 * p.z); };
  for (const Vec3 ratio : {Vec3(0.5), Vec3(1.0), Vec3(1.5), Vec3(2.0), Vec3(3.0), Vec3(0.5, 1.75, 3.0)}) {
    const Lattice texels = cell_lattice(volume.lattice(), Index3(cells * ratio));
    const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
    SampleSet samples;
    for (std::size_t t = 0; t < texels.count(); ++t) {
      const auto nx = std::size_t(texels.size.x);
      const auto ny = std::size_t(texels.size.y);
      const Vec3 p = to_volume.world(Vec3(t % nx, t / nx % ny, t / (nx * ny)));
      add_sample(samples, volume, p, {ramp(p)});
    }
    const ResampledGrid result = resamplers().create("direct")->resample(volume, samples, texels, {});
    const LightReader reader(volume, result.grid);
    for (const Vec3 place : {Vec3(0.3, 0.5, 0.7), Vec3(0.21, 0.77, 0.4), Vec3(0.5)}) {
      EXPECT_NEAR(reader.at_index(place * cells).x, ramp(place * cells), 1e-6);
      EXPECT_NEAR(reader.at_world(volume.lattice().frame.world(place * cells)).x, ramp(place * cells), 1e-6);
    }
  }
}

TEST(Direct, LeavesTexelsWithoutSampleUnlit) {
  const Volume volume = ramp_volume({4, 4, 4});
  SampleSet samples;
  add_sample(samples, volume, {1.5, 0.5, 2.5}, {3.0f});
  const Lattice texels = cell_lattice(volume.lattice());
  const ResampledGrid result = resamplers().create("direct")->resample(volume, samples, texels, {});
  for (std::size_t t = 0; t < texels.count(); ++t) EXPECT_EQ(result.lit[t], t == texels.offset(1, 0, 2) ? 1 : 0);
  EXPECT_EQ(result.grid.values[texels.offset(1, 0, 2)], 3.0f);
}

/// Samples [begin, end) without what parts may lack.
SampleSet part_of(const SampleSet& all, std::size_t begin, std::size_t end) {
  const auto channels = std::size_t(all.channels);
  SampleSet part;
  part.channels = all.channels;
  part.sites.positions = {all.sites.positions.begin() + std::ptrdiff_t(begin),
                          all.sites.positions.begin() + std::ptrdiff_t(end)};
  part.radiance = {all.radiance.begin() + std::ptrdiff_t(begin * channels),
                   all.radiance.begin() + std::ptrdiff_t(end * channels)};
  return part;
}

TEST(Direct, MakesOfPartsWhatItMakesOfAll) {
  const Volume volume = ramp_volume({5, 6, 7});
  const Lattice texels = cell_lattice(volume.lattice());
  const SampleSet all = part_of(one_a_texel(volume, texels), 7, texels.count());  // some texels stay unlit
  const auto direct = resamplers().create("direct");
  ASSERT_TRUE(direct->takes_parts());
  IlluminationGrid grid = unlit_grid(texels, all.channels);
  for (std::size_t begin = 0; begin < all.size(); begin += 20)
    direct->add_part(volume, part_of(all, begin, std::min(begin + 20, all.size())), grid, {});
  const ResampledGrid parts = told_by_bytes(std::move(grid));
  SampleSet same = one_a_texel(volume, texels);
  for (auto* array : {&same.sites.positions, &same.sites.normals}) array->erase(array->begin(), array->begin() + 7);
  for (auto* array : {&same.sites.isovalues, &same.variance}) array->erase(array->begin(), array->begin() + 7);
  same.radiance.erase(same.radiance.begin(), same.radiance.begin() + 7 * same.channels);
  const ResampledGrid at_once = direct->resample(volume, same, texels, {});
  EXPECT_EQ(parts.lit, at_once.lit);
  EXPECT_EQ(parts.grid.values, at_once.grid.values);  // no NaN is left
  EXPECT_EQ(std::count(parts.lit.begin(), parts.lit.end(), std::uint8_t(0)), 7);
}

TEST(Direct, AveragesSamplesAtOneTexel) {
  const Volume volume = ramp_volume({3, 3, 3});
  SampleSet samples;
  for (const float v : {1.0f, 2.0f, 6.0f}) add_sample(samples, volume, {0.5, 0.5, 0.5}, {v});
  const ResampledGrid result =
      resamplers().create("direct")->resample(volume, samples, cell_lattice(volume.lattice()), {});
  EXPECT_FLOAT_EQ(result.grid.values[0], 3.0f);
}

TEST(Direct, RefusesScatteredSamples) {
  const Volume volume = ramp_volume({3, 3, 3});
  for (const Vec3 p : {Vec3(0.5, 0.5, 0.6), Vec3(0.0, 0.5, 0.5)}) {
    SampleSet samples;
    add_sample(samples, volume, p, {1.0f});
    EXPECT_THROW((void)resamplers().create("direct")->resample(volume, samples, cell_lattice(volume.lattice()), {}),
                 InvalidInput);
  }
}

/// Light with a step at x = 6 and uniform noise of this breadth at every texel centre of a 12^3 block.
SampleSet noisy_step(const Volume& volume, double breadth) {
  SampleSet samples;
  for (int q = 0; q < 12 * 12 * 12; ++q) {
    const Index3 cell(q % 12, q / 12 % 12, q / 144);
    const double noise = breadth * (RandomStream(9, std::uint64_t(q)).uniform_double() - 0.5);
    add_sample(samples, volume, Vec3(cell) + 0.5, {float((cell.x < 6 ? 1.0 : 3.0) + noise)},
               float(breadth * breadth / 12.0));
  }
  return samples;
}

TEST(Direct, DenoisesSmoothLightAndKeepsItsEdges) {
  const Volume volume = ramp_volume({13, 13, 13});
  const Lattice texels = cell_lattice(volume.lattice());
  const auto errors = [&](const std::string& denoise) {
    const ResampledGrid result =
        resamplers().create("direct", {{"denoise", denoise}})->resample(volume, noisy_step(volume, 0.2), texels, {});
    std::array<double, 2> squares{};  // beside the edge and at it
    for (std::size_t t = 0; t < result.grid.values.size(); ++t) {
      const auto x = int(t % 12);
      const double d = double(result.grid.values[t]) - (x < 6 ? 1.0 : 3.0);
      squares[x >= 3 && x < 9 ? 1 : 0] += d * d / 864.0;
    }
    return squares;
  };
  const auto plain = errors("false");
  const auto denoised = errors("true");
  // Thirty samples average to a sixth of the noise; half of it is the claim.
  EXPECT_LT(denoised[0], 0.25 * plain[0]);
  // A step of 2, 35 times the noise's standard error, parts the windows: noise is taken out up to it. Half of a window
  // averages as well as a few samples do everywhere else.
  EXPECT_LT(denoised[1], 0.5 * plain[1]);
}

TEST(Direct, DenoisingLeavesExactSamplesAlone) {
  const Volume volume = ramp_volume({13, 13, 13});
  const Lattice texels = cell_lattice(volume.lattice());
  const SampleSet samples = noisy_step(volume, 0.0);
  const auto plain = resamplers().create("direct")->resample(volume, samples, texels, {});
  const auto denoised = resamplers().create("direct", {{"denoise", "true"}})->resample(volume, samples, texels, {});
  // Rounding of m + (e - m) and of the fit.
  for (std::size_t t = 0; t < plain.grid.values.size(); ++t) {
    EXPECT_NEAR(denoised.grid.values[t], plain.grid.values[t], 1e-5f);
  }
}

/// What resampler direct makes of samples at the cell centres of `volume`, denoised.
std::vector<float> denoised_texels(const Volume& volume, const SampleSet& samples, int threads = 0,
                                   const std::string& is_sharpened = "true") {
  Run run;
  if (threads > 0) run.threads = threads;
  const auto denoiser = resamplers().create("direct", {{"denoise", "true"}, {"sharpen", is_sharpened}});
  return denoiser->resample(volume, samples, cell_lattice(volume.lattice()), run).grid.values;
}

/// A lamp's light of one step, half of the height of the noise of the rest, and what lamps shine told apart.
SampleSet beside_a_lamp(const SampleSet& rest) {
  SampleSet samples = rest;
  samples.lamps_variance.assign(rest.size(), 0.0f);
  for (std::size_t s = 0; s < rest.size(); ++s) {
    samples.lamps.push_back(rest.sites.positions[s].y < 6.0f ? 0.0f : 0.1f);
    samples.radiance[s] += samples.lamps[s];
  }
  return samples;
}

// A step below the noise is one that no window can see: mixed with the rest, it would be smoothed away.
TEST(Direct, DenoisesTheRestAndLeavesTheEdgesOfKnownLampsAlone) {
  const Volume volume = ramp_volume({13, 13, 13});
  const SampleSet rest = noisy_step(volume, 0.2);
  const SampleSet samples = beside_a_lamp(rest);
  const std::vector<float> whole = denoised_texels(volume, samples);
  const std::vector<float> without = denoised_texels(volume, rest);
  // The rest is the difference of floats up to 4 and is added up again: their rounding, which least squares and choices
  // by sixth powers make somewhat larger.
  for (std::size_t t = 0; t < whole.size(); ++t) EXPECT_NEAR(whole[t], without[t] + samples.lamps[t], 2e-5f);
}

TEST(Direct, DenoisesLampsThatAreNoisyTooAndLeavesThemBlunt) {
  const Volume volume = ramp_volume({13, 13, 13});
  SampleSet samples = noisy_step(volume, 0.2);
  samples.lamps = samples.radiance;  // nothing else shines
  samples.lamps_variance = samples.variance;
  const SampleSet all = noisy_step(volume, 0.2);
  EXPECT_EQ(denoised_texels(volume, samples), denoised_texels(volume, all, 0, "false"));
  EXPECT_NE(denoised_texels(volume, samples), denoised_texels(volume, all));
}

/// What 16 rays of each texel say of a sky that a slope hides less and less of, up to none: no sample is brighter than
/// 1 in red, half and a quarter of that in green and blue.
SampleSet sky_above_a_slope(const Volume& volume) {
  SampleSet samples;
  samples.channels = 3;
  for (int q = 0; q < 12 * 12 * 12; ++q) {
    const Index3 cell(q % 12, q / 12 % 12, q / 144);
    const double open = std::min(1.0, 0.4 * cell.x);
    RandomStream random(9, std::uint64_t(q));
    int free = 0;
    for (int ray = 0; ray < 16; ++ray) free += random.uniform_double() < open ? 1 : 0;
    const float e = float(free) / 16.0f;
    add_sample(samples, volume, Vec3(cell) + 0.5, {e, 0.5f * e, 0.25f * e}, 0.4375f * e * (1.0f - e) / 15.0f);
  }
  return samples;
}

std::array<float, 3> brightest_of(const std::vector<float>& light) {
  std::array<float, 3> brightest{};
  for (std::size_t v = 0; v < light.size(); ++v) brightest[v % 3] = std::max(brightest[v % 3], light[v]);
  return brightest;
}

TEST(Direct, DenoisedLightIsReadNoBrighterThanTheBrightestSample) {
  const Volume volume = ramp_volume({13, 13, 13});
  const SampleSet rest = sky_above_a_slope(volume);
  SampleSet lamps = rest;  // on a black rest
  lamps.lamps = rest.radiance;
  lamps.lamps_variance = rest.variance;
  const std::array<float, 3> most = brightest_of(rest.radiance);
  for (const SampleSet& samples : {rest, lamps}) {
    for (const char* near_field : {"true", "false"}) {
      const auto direct = resamplers().create("direct", {{"denoise", "true"}, {"near_field", near_field}});
      ResampledGrid light = direct->resample(volume, samples, cell_lattice(volume.lattice()), {});
      direct->add_detail(volume, samples, light, {});
      const LightReader reader(volume, light.grid);
      for (double x = 0.5; x < 12.0; x += 0.25)
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_LE(reader.at_index({x, 6.5, 6.5})[int(c)], double(most[light.grid.detail.empty() ? c : 0]));
    }
  }
}

TEST(Direct, DenoisesDimLightAsItDoesBrightLight) {
  const Volume volume = ramp_volume({13, 13, 13});
  const std::vector<float> usual = denoised_texels(volume, noisy_step(volume, 0.2));
  for (const int power : {-40, -20, 20}) {
    SampleSet samples = noisy_step(volume, 0.2);
    for (float& e : samples.radiance) e = std::ldexp(e, power);
    for (float& v : samples.variance) v = std::ldexp(v, 2 * power);
    std::vector<float> scaled = denoised_texels(volume, samples);
    for (float& e : scaled) e = std::ldexp(e, -power);
    EXPECT_EQ(scaled, usual) << power;
  }
}

TEST(Direct, DenoisesToTheSameBitsForAnyNumberOfThreads) {
  const Volume volume = ramp_volume({13, 13, 13});
  const SampleSet samples = beside_a_lamp(noisy_step(volume, 0.2));
  const std::vector<float> one = denoised_texels(volume, samples, 1);
  EXPECT_EQ(one, denoised_texels(volume, samples, 2));
  EXPECT_EQ(one, denoised_texels(volume, samples, 5));
}

TEST(Direct, AsksForLampsToldApartOnlyToDenoise) {
  EXPECT_EQ(resamplers().create("direct")->lamps(), LampLight::kWithin);
  EXPECT_EQ(resamplers().create("direct", {{"denoise", "true"}})->lamps(), LampLight::kToldApart);
}

TEST(Direct, AsksForRaysByNoiseOnlyToDenoise) {
  EXPECT_EQ(resamplers().create("direct")->spread(), RaySpread::kEven);
  EXPECT_EQ(resamplers().create("direct", {{"denoise", "true"}})->spread(), RaySpread::kByNoise);
  EXPECT_EQ(resamplers().create("direct", {{"denoise", "true"}, {"spread", "false"}})->spread(), RaySpread::kEven);
}

}  // namespace
}  // namespace isolux
