// Rays spread over the sites by the noise of a first quarter.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat/gather.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <vector>

#include "cell_sites.h"
#include "physics_support.h"

namespace isolux::test {
namespace {

constexpr int kRays = 16;

Sites sites_in_cells(const Volume& volume) {
  std::vector<std::size_t> texel;
  return cell_sites(volume, OuterSide::kLower, texel);
}

TraceSettings spread_by(RaySpread spread) {
  return {.rays = kRays, .bounces = 0, .nets = RayNets::kInterleaved, .spread = spread};
}

TraceResult lit(const Volume& volume, const Scene& scene, const TraceSettings& settings, std::uint64_t seed,
                int threads = 0) {
  Run run;
  run.seed = seed;
  run.threads = threads;
  return tracers().create("wide")->trace(volume, scene, sites_in_cells(volume), settings, run);
}

/// Two balls under a white sky: most rays see it, and those of sites between the balls do not.
struct TwoBalls {
  Volume volume = two_spheres(33);
  Scene scene = furnace(0.5f);
  std::vector<float> exact = lit(volume, scene, {.rays = 1024, .bounces = 0}, 77).samples.radiance;
  std::vector<TraceResult> even;
  std::vector<TraceResult> spread;

  TwoBalls() {
    for (const std::uint64_t seed : {1, 2, 3}) {
      even.push_back(lit(volume, scene, spread_by(RaySpread::kEven), seed));
      spread.push_back(lit(volume, scene, spread_by(RaySpread::kByNoise), seed));
    }
  }

  [[nodiscard]] double mean_square(const std::vector<TraceResult>& results) const {
    double sum = 0.0;
    for (const TraceResult& result : results)
      for (std::size_t s = 0; s < exact.size(); ++s)
        sum += std::pow(double(result.samples.radiance[s]) - double(exact[s]), 2.0);
    return sum / double(results.size() * exact.size());
  }
};

const TwoBalls& balls() {
  static const TwoBalls once;
  return once;
}

TEST(RaysBetweenBalls, GoWhereNoiseIs) {
  for (const TraceResult& result : balls().spread) {
    ASSERT_EQ(result.rays.size(), balls().exact.size());
    const double mean = std::accumulate(result.rays.begin(), result.rays.end(), 0.0) / double(balls().exact.size());
    EXPECT_LE(mean, double(kRays));
    EXPECT_GT(mean, 0.8 * double(kRays));  // but for what was traced in vain, and steps of two
    const std::set<std::uint32_t> counts(result.rays.begin(), result.rays.end());
    for (const std::uint32_t count : counts) EXPECT_TRUE((std::set<std::uint32_t>{4, 8, 16, 32, 64}).contains(count));
    std::map<std::uint32_t, std::pair<double, double>> noise;
    for (std::size_t s = 0; s < balls().exact.size(); ++s) {
      const double d = double(balls().even.front().samples.radiance[s]) - double(balls().exact[s]);
      noise[result.rays[s]].first += d * d;
      noise[result.rays[s]].second += 1.0;
    }
    const auto& [few, many] = std::pair(noise.begin()->second, noise.rbegin()->second);
    EXPECT_GT(many.first / many.second, 4.0 * few.first / few.second);
  }
}

TEST(RaysBetweenBalls, LeaveLessNoiseForAsMany) {
  EXPECT_LT(balls().mean_square(balls().spread), 0.6 * balls().mean_square(balls().even));
  // More than are asked, but for the sites that are lit twice to know the noise.
  EXPECT_LT(double(balls().spread.front().counters.rays), 1.02 * double(balls().even.front().counters.rays));
}

TEST(RaysBetweenBalls, SayTheNoiseTheyLeave) {
  double said = 0.0;
  for (const TraceResult& result : balls().spread)
    for (const float variance : result.samples.variance) said += double(variance);
  said /= double(balls().spread.size() * balls().exact.size());
  const double ratio = std::sqrt(balls().mean_square(balls().spread) / said);
  EXPECT_GT(ratio, 1.0 / 1.3);
  EXPECT_LT(ratio, 1.3);
}

TEST(RaysBetweenBalls, AreTheSameForAnyNumberOfThreads) {
  const TraceResult one = lit(balls().volume, balls().scene, spread_by(RaySpread::kByNoise), 1, 1);
  EXPECT_EQ(one.samples.radiance, balls().spread.front().samples.radiance);
  EXPECT_EQ(one.samples.variance, balls().spread.front().samples.variance);
  EXPECT_EQ(one.rays, balls().spread.front().rays);
}

TEST(RaysBetweenBalls, LeaveLampsLightAsItIs) {
  Scene scene = balls().scene;
  scene.lights.emplace_back(SunLight{.direction = {0.0f, 1.0f, 3.0f}, .irradiance = Vec3f(2.0f)});
  TraceSettings settings = spread_by(RaySpread::kByNoise);
  settings.lamps = LampLight::kToldApart;
  const TraceResult spread = lit(balls().volume, scene, settings, 1);
  settings.spread = RaySpread::kEven;
  const TraceResult even = lit(balls().volume, scene, settings, 1);
  EXPECT_EQ(spread.samples.lamps, even.samples.lamps);
  EXPECT_EQ(spread.rays, balls().spread.front().rays);
  for (std::size_t s = 0; s < balls().exact.size(); ++s)
    EXPECT_NEAR(spread.samples.radiance[s] - spread.samples.lamps[s], balls().spread.front().samples.radiance[s],
                1e-6f);
}

TEST(RaysByNoise, AreAsManyOfEachWhereThatGainsLittle) {
  const Volume volume = gyroid(33);
  Scene scene = furnace(0.5f);
  scene.environment = half_sky({0.3f, 0.2f, 1.0f});
  const TraceResult even = lit(volume, scene, spread_by(RaySpread::kEven), 1);
  const TraceResult spread = lit(volume, scene, spread_by(RaySpread::kByNoise), 1);
  EXPECT_TRUE(spread.rays.empty());
  EXPECT_EQ(spread.samples.radiance, even.samples.radiance);
  EXPECT_EQ(spread.samples.variance, even.samples.variance);
}

TEST(RaysByNoise, AreNotSpreadWhereTheyCannotBe) {
  const Volume volume = two_spheres(33);
  const Scene scene = furnace(0.5f);
  TraceSettings settings = spread_by(RaySpread::kByNoise);
  EXPECT_FALSE(lit(volume, scene, settings, 1).rays.empty());
  settings.bounces = 2;
  EXPECT_TRUE(lit(volume, scene, settings, 1).rays.empty());
  settings.bounces = 0;
  settings.nets = RayNets::kIndependent;
  EXPECT_TRUE(lit(volume, scene, settings, 1).rays.empty());
  settings.nets = RayNets::kInterleaved;
  settings.rays = 15;
  EXPECT_TRUE(lit(volume, scene, settings, 1).rays.empty());
}

/// By site.
std::map<std::uint32_t, std::vector<Vec3f>> directions(const Volume& volume, const Sites& sites,
                                                       const GatherSettings& settings) {
  std::map<std::uint32_t, std::vector<Vec3f>> result;
  std::mutex adding;
  (void)gather(volume, sites, settings, Run{}, [&](const GatheredRays& gathered) {
    const std::scoped_lock lock(adding);
    for (std::size_t i = 0; i < gathered.sites.size(); ++i) {
      std::vector<Vec3f>& own = result[gathered.sites[i]];
      EXPECT_TRUE(own.empty());  // once
      for (std::size_t k = i * gathered.rays; k < (i + 1) * gathered.rays; ++k)
        own.emplace_back(gathered.direction[0][k], gathered.direction[1][k], gathered.direction[2][k]);
    }
  });
  return result;
}

TEST(Gather, AsksOnlyTheSitesItIsToldTo) {
  const Volume volume = gyroid(9);
  const Sites sites = sites_in_cells(volume);
  const std::vector<std::uint32_t> only{3, 17, 200, 201};
  for (const RayNets nets : {RayNets::kIndependent, RayNets::kInterleaved}) {
    const auto all = directions(volume, sites, {.rays = 8, .nets = nets});
    const auto some = directions(volume, sites, {.rays = 8, .only = only, .nets = nets});
    EXPECT_EQ(all.size(), sites.size());
    ASSERT_EQ(some.size(), only.size());
    for (const std::uint32_t site : only) EXPECT_EQ(some.at(site), all.at(site));
  }
  const std::vector<std::uint32_t> beyond{std::uint32_t(sites.size())};
  EXPECT_THROW((void)gather(volume, sites, {.only = beyond}, isolux::Run{}, [](const GatheredRays&) {}), InvalidInput);
}

}  // namespace
}  // namespace isolux::test
