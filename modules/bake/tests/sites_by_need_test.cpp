// Scattered sites by need: more of them where light changes, as many in all.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <cmath>

#include "sites_by_need.h"

namespace isolux::test {
namespace {

/// Points of a fine lattice over a cube of 8^3 cells.
Sites lattice_sites(int an_axis) {
  Sites sites;
  for (int q = 0; q < an_axis * an_axis * an_axis; ++q) {
    const Vec3f place(Index3(q % an_axis, q / an_axis % an_axis, q / an_axis / an_axis));
    sites.positions.push_back((place + 0.5f) * (8.0f / float(an_axis)));
    sites.isovalues.push_back(0.0f);
    sites.normals.emplace_back(0.0f, 0.0f, 1.0f);
  }
  return sites;
}

/// 1 before x = 4.5 and 3 behind.
SampleSet step(const Sites& sites, float variance) {
  SampleSet samples;
  samples.sites = sites;
  for (const Vec3f& p : sites.positions) samples.radiance.push_back(p.x < 4.5f ? 1.0f : 3.0f);
  samples.variance.assign(sites.size(), variance);
  return samples;
}

std::size_t near_step(const Sites& sites) {
  std::size_t count = 0;
  for (const Vec3f& p : sites.positions) count += p.x >= 3.0f && p.x < 6.0f ? 1 : 0;
  return count;
}

TEST(SitesByNeed, GoWhereLightChanges) {
  const Volume volume = read_volume("gen:gyroid:9");
  const Sites sites = sites_by_need(volume, step(lattice_sites(16), 0.0f), lattice_sites(24), 2000, isolux::Run{});
  // 3/8 of the candidates lie in the cell with the step or beside it; the rest differ by nothing, and get the least.
  EXPECT_GT(double(near_step(sites)), 0.95 * double(sites.size()));
  // Each of 5,184 candidates there is kept or not by itself: the number kept spreads by less than 36.
  EXPECT_NEAR(double(sites.size()), 2000.0, 5.0 * 36.0);
}

TEST(SitesByNeed, AreEvenWhereAllDifferencesAreNoise) {
  const Volume volume = read_volume("gen:gyroid:9");
  // The samples of the cells with the step differ by less than a variance of 2 explains.
  const Sites sites = sites_by_need(volume, step(lattice_sites(16), 2.0f), lattice_sites(24), 2000, isolux::Run{});
  // 3/8 of 2000, spread by less than 22.
  EXPECT_NEAR(double(near_step(sites)), 0.375 * double(sites.size()), 5.0 * 22.0);
}

TEST(SitesByNeed, LightIsLessWrongThanOfEvenSites) {
  // The light of two balls changes fast where they nearly meet and hardly anywhere else.
  const Volume volume = read_volume("gen:two-spheres:17");
  const auto light = [&](TexelSites which, double sites, int rays) {
    BakeSettings settings;
    settings.resampler.name = "fit";
    settings.trace = {.rays = rays, .bounces = 0};
    settings.texel_sites = which;
    settings.sites_a_cell = sites;
    return bake(volume, Scene{}, settings, builtin_stages(), isolux::Run{});
  };
  const BakeResult truth = light(TexelSites::kAll, 64.0, 64);
  const auto error = [&](const BakeResult& result) {
    double squares = 0.0;
    for (std::size_t t = 0; t < truth.light.values.size(); ++t)
      squares += std::pow(double(result.light.values[t]) - double(truth.light.values[t]), 2.0);
    return squares;
  };
  const BakeResult even = light(TexelSites::kAll, 4.0, 64);
  const BakeResult need = light(TexelSites::kNeeded, 4.0, 64);
  EXPECT_LT(double(need.counters.rays), 1.05 * double(even.counters.rays));
  EXPECT_LT(error(need), error(even));
}

TEST(SitesByNeed, GiveTheSameBitsOnAnyNumberOfThreads) {
  const Volume volume = read_volume("gen:gyroid:13");
  const auto light = [&](int threads) {
    isolux::Run run;
    run.threads = threads;
    BakeSettings settings;
    settings.resampler.name = "fit";
    settings.trace = {.rays = 8, .bounces = 1};
    settings.texel_sites = TexelSites::kNeeded;
    return bake(volume, Scene{}, settings, builtin_stages(), run).light.values;
  };
  EXPECT_EQ(light(1), light(3));
}

TEST(SitesByNeed, RefuseAnError) {
  BakeSettings settings;
  settings.resampler.name = "fit";
  settings.texel_sites = TexelSites::kNeeded;
  settings.target_rmse = 0.1;
  EXPECT_THROW((void)bake(read_volume("gen:sphere:9"), Scene{}, settings, builtin_stages(), isolux::Run{}),
               InvalidInput);
}

}  // namespace
}  // namespace isolux::test
