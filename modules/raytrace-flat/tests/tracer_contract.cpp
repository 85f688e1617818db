// What every backend of the catalogue promises besides physics.
#include <gtest/gtest.h>
#include <isolux/core/error.h>

#include <cstdint>
#include <vector>

#include "physics_support.h"

namespace isolux::test {
namespace {

class TracerContract : public EveryTracer {};
ISOLUX_FOR_EVERY_TRACER(TracerContract);

Sites some_sites(const Volume& volume, int count) {
  return sites_at(volume, random_positions(count, 1, [](const Vec3&) { return true; }), OuterSide::kLower);
}

Scene busy_scene() {
  Scene scene = furnace(0.7f);
  scene.lights = {SunLight{.direction = {1, 1, 1}},
                  RectangleLight{.center = {0.5f, 0.5f, 2.0f}, .u = {0.2f, 0, 0}, .v = {0, -0.2f, 0}}};
  return scene;
}

TEST_P(TracerContract, TheBitsDoNotDependOnTheThreads) {
  const Volume volume = gyroid(20);
  const Sites sites = some_sites(volume, 300);
  const auto result = [&](int threads) {
    isolux::Run run;
    run.threads = threads;
    return tracers().create(GetParam())->trace(volume, busy_scene(), sites, {.rays = 16}, run);
  };
  const TraceResult one = result(1);
  for (const int threads : {2, 5}) {
    const TraceResult other = result(threads);
    EXPECT_EQ(one.samples.radiance, other.samples.radiance);
    EXPECT_EQ(one.samples.variance, other.samples.variance);
    EXPECT_EQ(one.counters.rays, other.counters.rays);
    EXPECT_EQ(one.counters.cells, other.counters.cells);
  }
}

TEST_P(TracerContract, SeedsChangeTheNoiseOnly) {
  const Volume volume = gyroid(20);
  const Sites sites = some_sites(volume, 300);
  const SampleSet a = trace(volume, furnace(0.7f), sites, 64, kAllBounces, {}, 1).samples;
  const SampleSet b = trace(volume, furnace(0.7f), sites, 64, kAllBounces, {}, 2).samples;
  EXPECT_NE(a.radiance, b.radiance);
  const ErrorOfE error = error_of(a, [&](std::size_t i) { return double(b.radiance[i]); });
  EXPECT_LT(error.rms, 0.08);              // two of .4/sqrt(64) at most
  EXPECT_LT(std::abs(error.bias), 0.015);  // four times that over sqrt(300)
}

// The stated variance against the scatter of 64 independent runs.
TEST_P(TracerContract, TheVarianceIsThatOfTheMean) {
  const Volume volume = gyroid(20);
  const Sites sites = some_sites(volume, 40);
  Scene scene = furnace(0.7f);
  scene.environment = half_sky({0.0f, 0.0f, 1.0f});
  constexpr int kRuns = 64;
  std::vector<double> sum(sites.size(), 0.0);
  std::vector<double> squares(sites.size(), 0.0);
  double stated = 0.0;
  for (int r = 0; r < kRuns; ++r) {
    const SampleSet samples = trace(volume, scene, sites, 64, kAllBounces, {}, std::uint64_t(r) + 100).samples;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      sum[i] += double(samples.radiance[i]);
      squares[i] += double(samples.radiance[i]) * double(samples.radiance[i]);
      stated += double(samples.variance[i]) / kRuns;
    }
  }
  double seen = 0.0;
  for (std::size_t i = 0; i < sites.size(); ++i) seen += (squares[i] - sum[i] * sum[i] / kRuns) / (kRuns - 1);
  // A factor of 1.3 of the error would be one of 1.7 here; neighbouring strata alone say up to 3.
  EXPECT_GT(stated, 0.85 * seen);
  EXPECT_LT(stated, 1.2 * seen);
}

TEST_P(TracerContract, TheSitesComeBackWithTheirLight) {
  const Volume volume = gyroid(20);
  const Sites sites = some_sites(volume, 70);
  const TraceResult result = trace(volume, busy_scene(), sites, 4, 2);
  EXPECT_EQ(result.samples.sites.positions, sites.positions);
  EXPECT_EQ(result.samples.sites.isovalues, sites.isovalues);
  EXPECT_EQ(result.samples.sites.normals, sites.normals);
  EXPECT_EQ(result.samples.channels, 1);
  EXPECT_EQ(result.samples.radiance.size(), sites.size());
  EXPECT_EQ(result.samples.variance.size(), sites.size());
  EXPECT_GE(result.counters.rays, 4 * sites.size());
  EXPECT_GT(result.counters.hits, 0u);
  Scene coloured = busy_scene();
  coloured.albedo = {.keys = {{0.0f, {0.1f, 0.2f, 0.3f}}}};
  EXPECT_EQ(trace(volume, coloured, sites, 4, 2).samples.radiance.size(), 3 * sites.size());
}

TEST_P(TracerContract, NoSitesAndSitesWithoutNormals) {
  const Volume volume = gyroid(20);
  EXPECT_EQ(trace(volume, furnace(0.5f), {}, 8, 0).samples.size(), 0u);
  Sites sites = some_sites(volume, 2);
  sites.normals[0] = Vec3f(0.0f);
  const SampleSet samples = trace(volume, furnace(0.5f), sites, 8, 0).samples;
  EXPECT_EQ(samples.radiance[0], 0.0f);
}

TEST_P(TracerContract, BadRequestsAreRefusedInWords) {
  const Volume volume = gyroid(8);
  Sites uneven = some_sites(volume, 3);
  uneven.isovalues.pop_back();
  EXPECT_THROW((void)trace(volume, furnace(0.5f), uneven, 8, 0), InvalidInput);
  EXPECT_THROW((void)trace(volume, furnace(0.5f), some_sites(volume, 3), 0, 0), InvalidInput);
  EXPECT_THROW((void)trace(volume, furnace(0.5f), some_sites(volume, 3), 8, -2), InvalidInput);
  EXPECT_THROW((void)trace(volume, furnace(1.5f), some_sites(volume, 3), 8, 0), InvalidInput);
  EXPECT_THROW((void)tracers().create(GetParam(), {{"no_such_option", "1"}}), InvalidInput);
}

TEST_P(TracerContract, AStoppedRunSaysSo) {
  const Volume volume = gyroid(8);
  std::stop_source source;
  source.request_stop();
  isolux::Run run;
  run.stop = source.get_token();
  EXPECT_THROW((void)tracers().create(GetParam())->trace(volume, furnace(0.5f), some_sites(volume, 100), {}, run),
               Cancelled);
}

TEST_P(TracerContract, SitesExactlyOnGridPointsFacesAndEdges) {
  const Volume volume = cavity(17);
  std::vector<Vec3> positions;
  for (int k = 0; k < 17; ++k)
    for (int j = 0; j < 17; ++j) positions.emplace_back(2.0 / 16, j / 16.0, k / 16.0);
  const Sites sites = sites_at(volume, positions, OuterSide::kLower);
  const SampleSet samples = trace(volume, furnace(1.0f), sites, 2, kAllBounces).samples;
  // White furnace again: radii above .5 are open, those below are pockets.
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double radius(samples.sites.isovalues[i]);
    if (radius > 0.49 && radius < 0.52) continue;
    EXPECT_NEAR(samples.radiance[i], radius > 0.5 ? 1.0 : 0.0, 1e-5) << radius;
  }
}

TEST_P(TracerContract, PathsThatAreCutOffAreCounted) {
  // A closed ball of white walls, where all paths go on for ever, and one that is wide open.
  const Volume volume = cavity(33);
  const TrilinearField field(volume);
  Sites sites;
  for (const double x : {0.1, 0.15}) {
    const Vec3 p = Vec3(x, 0.5, 0.5) * 32.0;
    sites.positions.emplace_back(p);
    sites.isovalues.push_back(float(field.value(p)));
    sites.normals.emplace_back(field.normal(p, OuterSide::kLower, GradientKind::kCell));
  }
  sites.positions.emplace_back(2.5f, 2.5f, 16.5f);
  sites.isovalues.push_back(float(field.value(Vec3(sites.positions.back()))));
  sites.normals.emplace_back(field.normal(Vec3(sites.positions.back()), OuterSide::kLower, GradientKind::kCell));
  const auto traced = [&](float albedo, int bounces) {
    return tracers()
        .create(GetParam())
        ->trace(volume, furnace(albedo), sites, {.rays = 8, .bounces = bounces}, isolux::Run{});
  };
  const TraceResult white = traced(1.0f, kAllBounces);
  EXPECT_GE(white.counters.cut, 16u);
  EXPECT_EQ(white.samples.radiance[0], 0.0f);
  EXPECT_NEAR(white.samples.radiance[2], 1.0f, 1e-5f);
  if (GetParam() == "wide") {
    EXPECT_EQ(white.cut, (std::vector<std::uint32_t>{8, 8, 0}));
  }
  for (const TraceResult& other : {traced(0.8f, kAllBounces), traced(1.0f, 1000), traced(1.0f, 3)}) {
    EXPECT_EQ(other.counters.cut, 0u);
    EXPECT_TRUE(other.cut.empty());
  }
  EXPECT_GT(traced(1.0f, 1001).counters.cut, 0u);
}

}  // namespace
}  // namespace isolux::test
