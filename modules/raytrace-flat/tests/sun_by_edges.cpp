// Rays to suns near the edges of shadows, and a few elsewhere, where rays are spread.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cell_sites.h"
#include "physics_support.h"
#include "shadow_edges.h"
#include "wide/site_cells.h"

namespace isolux::test {
namespace {

constexpr float kBrightness = 2.0f;
const Vec3 kTowards = glm::normalize(Vec3(1.0, 0.2, 0.3));  // one of two spheres is in the shadow of the other

TraceSettings even(int rays) { return {.rays = rays, .bounces = 0}; }
TraceSettings spread(int rays) {
  return {.rays = rays, .bounces = 0, .nets = RayNets::kInterleaved, .spread = RaySpread::kByNoise};
}

Scene sunny(float diameter_deg) {
  Scene scene = darkness(0.5f);
  scene.lights = {
      SunLight{.direction = Vec3f(kTowards), .irradiance = Vec3f(kBrightness), .angular_diameter_deg = diameter_deg}};
  return scene;
}

TraceResult in_the_sun(const Volume& volume, const Scene& scene, const TraceSettings& settings, std::uint64_t seed = 1,
                       int threads = 0) {
  std::vector<std::size_t> texel;
  isolux::Run run;
  run.seed = seed;
  run.threads = threads;
  return tracers().create("wide")->trace(volume, scene, cell_sites(volume, OuterSide::kLower, texel), settings, run);
}

std::vector<float> true_light(const Volume& volume, const Scene& scene) {
  return in_the_sun(volume, scene, even(1024), 7).samples.radiance;
}

double rms_apart(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a[i]) - double(b[i]), 2.0);
  return std::sqrt(sum / double(a.size()));
}

TEST(SunByEdges, IsMoreRightFromAsManyRays) {
  const Volume volume = two_spheres(49);
  for (const float diameter : {0.53f, 8.0f}) {
    const Scene scene = sunny(diameter);
    const std::vector<float> truth = true_light(volume, scene);
    const TraceResult all = in_the_sun(volume, scene, even(16));
    const TraceResult some = in_the_sun(volume, scene, spread(16));
    EXPECT_LT(rms_apart(some.samples.radiance, truth), 0.6 * rms_apart(all.samples.radiance, truth)) << diameter;
    EXPECT_LE(some.counters.rays, all.counters.rays);
    EXPECT_EQ(all.counters.known, 0u);
    EXPECT_GT(some.counters.known, 0u);
  }
}

TEST(SunByEdges, SaysTheNoiseItLeaves) {
  const Volume volume = gyroid(33);
  const Scene scene = sunny(8.0f);
  const std::vector<float> truth = true_light(volume, scene);
  double squares = 0.0;
  double said = 0.0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SampleSet found = in_the_sun(volume, scene, spread(16), seed).samples;
    squares += std::pow(rms_apart(found.radiance, truth), 2.0);
    for (const float variance : found.variance) said += double(variance) / double(truth.size());
  }
  const double ratio = std::sqrt(squares / said);
  EXPECT_GT(ratio, 1.0 / 1.3);
  EXPECT_LT(ratio, 1.3);
}

TEST(SunByEdges, IsKnownAwayFromThem) {
  const Volume volume = two_spheres(49);
  for (const float diameter : {0.0f, 0.53f, 8.0f}) {
    const SampleSet found = in_the_sun(volume, sunny(diameter), spread(16)).samples;
    std::size_t known = 0;
    std::size_t facing = 0;
    for (std::size_t s = 0; s < found.size(); ++s) {
      const double cosine = glm::dot(Vec3(found.sites.normals[s]), kTowards);
      if (cosine < std::sin(double(diameter) * std::numbers::pi / 360.0) + 0.1) continue;
      ++facing;
      if (found.variance[s] > 0.0f) continue;
      ++known;
      const double whole = double(kBrightness) * cosine / std::numbers::pi;
      EXPECT_NEAR(found.radiance[s], found.radiance[s] > 0.5 * whole ? whole : 0.0, 1e-6 * whole) << diameter;
    }
    EXPECT_GT(2 * known, facing) << diameter;
  }
}

TEST(SunByEdges, AsksAllWhereSitesDoNotTellEachOther) {
  const Volume volume = noise(Index3(25), 3);
  const TraceResult all = in_the_sun(volume, sunny(2.0f), even(32));
  const TraceResult some = in_the_sun(volume, sunny(2.0f), spread(32));
  EXPECT_EQ(some.samples.radiance, all.samples.radiance);
  EXPECT_EQ(some.samples.variance, all.samples.variance);
  EXPECT_EQ(some.counters.known, 0u);
}

TEST(SunByEdges, AsksAPointOnce) {
  const Volume volume = two_spheres(33);
  const TraceResult all = in_the_sun(volume, sunny(0.0f), even(64));
  const TraceResult once = in_the_sun(volume, sunny(0.0f), spread(64));
  EXPECT_LT(rms_apart(once.samples.radiance, all.samples.radiance), 1e-7);
  EXPECT_EQ(64 * once.counters.rays, all.counters.rays);
}

TEST(SunByEdges, IsTheSameForAnyNumberOfThreads) {
  const Volume volume = two_spheres(49);
  const TraceResult one = in_the_sun(volume, sunny(8.0f), spread(16), 1, 1);
  const TraceResult two = in_the_sun(volume, sunny(8.0f), spread(16), 1, 2);
  EXPECT_EQ(one.samples.radiance, two.samples.radiance);
  EXPECT_EQ(one.samples.variance, two.samples.variance);
  EXPECT_EQ(one.counters.rays, two.counters.rays);
  EXPECT_GT(one.counters.known, 0u);
}

Sites sites_at_index(const std::vector<Vec3f>& positions) {
  Sites sites;
  sites.positions = positions;
  sites.isovalues.resize(positions.size());
  sites.normals.resize(positions.size(), Vec3f(0.0f, 0.0f, 1.0f));
  return sites;
}

TEST(ShadowEdges, AreWhereSomeSeeTheLampAndSomeDoNot) {
  // Rows along x of 8x8 sites: all of a slice see the same.
  using enum LampSeen;
  const std::vector<LampSeen> row{kAll,  kAll,    kAll,  kNone, kNone, kTurnedAway, kNone,
                                  kNone, kRising, kNone, kNone, kSome, kNone};
  const std::vector<bool> near_row{false, false, true, true, false, false, false, false, true, false, true, true, true};
  std::vector<Vec3f> places;
  std::vector<LampSeen> seen;
  std::vector<bool> expected;
  for (int column = 0; column < 64; ++column) {
    for (std::size_t x = 0; x < row.size(); ++x) {
      places.push_back(Vec3f(x, column % 8, column / 8) + 0.5f);
      seen.push_back(row[x]);
      expected.push_back(near_row[x]);
    }
  }
  const ShadowEdges edges = find_shadow_edges(sites_at_index(places), seen);
  EXPECT_EQ(edges.near, expected);
  EXPECT_TRUE(edges.alone.empty());
}

TEST(ShadowEdges, AreFoundByTheirSitesAloneWhereAllAboutAgree) {
  using enum LampSeen;
  std::vector<Vec3f> places;
  for (int i = 0; i < 1000; ++i) places.push_back(Vec3f(i % 10, i / 10 % 10, i / 100) + 0.5f);
  std::vector<LampSeen> seen(places.size(), kAll);
  const auto at = [](int x, int y, int z) { return std::size_t(100 * z + 10 * y + x); };
  seen[at(2, 2, 2)] = kSome;
  seen[at(2, 7, 7)] = kSome;
  seen[at(3, 8, 7)] = kSome;  // not alone: next to the one before
  seen[at(7, 3, 3)] = kSome;
  seen[at(7, 3, 4)] = kNone;  // there is an edge, whatever (7, 3, 3) saw
  EXPECT_EQ(find_shadow_edges(sites_at_index(places), seen).alone, std::vector<std::uint32_t>{at(2, 2, 2)});
}

TEST(ShadowEdges, MayBeWhereFewSitesTell) {
  std::vector<Vec3f> places{{100.5f, 100.5f, 100.5f}};
  for (int i = 0; i < 1000; ++i) places.push_back(Vec3f(i % 10, i / 10 % 10, i / 100) + 0.5f);
  const std::vector<LampSeen> seen(places.size(), LampSeen::kAll);
  const std::vector<bool> near = find_shadow_edges(sites_at_index(places), seen).near;
  EXPECT_TRUE(near[0]);
  EXPECT_EQ(std::count(near.begin(), near.end(), true), 1);
}

TEST(CellBits, AreDilatedToTheCellsAbout) {
  const wide::SiteCells::Cell end{130, 7, 5};
  RandomStream random(1, 2);
  std::vector<wide::SiteCells::Cell> chosen;
  wide::CellBits bits(end);
  for (int i = 0; i < 40; ++i) {
    const auto below = [&](std::uint32_t n) { return std::uint32_t(random.uniform_double() * n); };
    chosen.push_back({below(end.x), below(end.y), below(end.z)});
    bits.set(chosen.back());
  }
  const wide::CellBits few = bits;
  bits.dilate();
  const auto near = [](std::uint32_t a, std::uint32_t b) { return (a > b ? a - b : b - a) <= 1; };
  for (std::uint32_t z = 0; z < end.z; ++z) {
    for (std::uint32_t y = 0; y < end.y; ++y) {
      for (std::uint32_t x = 0; x < end.x; ++x) {
        const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&](const wide::SiteCells::Cell& cell) {
          return near(x, cell.x) && near(y, cell.y) && near(z, cell.z);
        });
        EXPECT_EQ((bits[{x, y, z}]), is_near) << x << " " << y << " " << z;
        EXPECT_EQ(few.count_about({x, y, z}) > 0, is_near);
      }
    }
  }
}

}  // namespace
}  // namespace isolux::test
