// The wide kernels against the scalar oracle, ray by ray, at every instruction set of this machine.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/raytrace_flat/level_set_intersector.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <string>

#include "physics_support.h"
#include "stress.h"
#include "wide/rays.h"
#include "wide_targets.h"

namespace isolux::test {
namespace {

enum class Place : std::uint8_t { kAnywhere, kOnFaces, kBesideFaces, kOnGridPoints };

/// Sites in the box: inside cells, exactly on faces and corners of cells, or a few roundings off a face.
Sites random_sites(const Volume& volume, int count, Place place, OuterSide outer) {
  const TrilinearField field(volume);
  RandomStream random(11, std::uint64_t(place));
  const Vec3 extent(volume.lattice().size - 1);
  Sites sites;
  while (int(sites.size()) < count) {
    Vec3f p(Vec3(random.uniform_double(), random.uniform_double(), random.uniform_double()) * extent);
    if (place == Place::kOnFaces) p[int(sites.size() % 3)] = std::round(p[int(sites.size() % 3)]);
    if (place == Place::kBesideFaces) {
      const int axis = int(sites.size() % 3);
      const float face = std::round(p[axis]);
      const float step = std::max(face, 1.0f) * 0x1p-24f * (face < float(extent[axis]) ? 1.0f : -1.0f);
      p[axis] = face + step * float(random.next_bits() % 8 + 1) * (face > 0.0f && sites.size() % 2 == 0 ? -1.0f : 1.0f);
      p[axis] = std::clamp(p[axis], 0.0f, float(extent[axis]));
    }
    if (place == Place::kOnGridPoints) p = glm::round(p);
    const Vec3 normal = field.normal(Vec3(p), outer, GradientKind::kCentralDifferences);
    const double value = field.value(Vec3(p));
    // A site beside a plateau of whole numbers, but named by the plateau's isovalue: on which of them it lies is a
    // matter of the last bit.
    if (normal == Vec3(0.0) || (float(value) == std::round(float(value)) && value != double(float(value)))) continue;
    sites.positions.push_back(p);
    sites.isovalues.push_back(float(field.value(Vec3(p))));
    sites.normals.emplace_back(normal);
  }
  return sites;
}

struct Disagreement {
  std::size_t rays = 0;
  std::size_t hits = 0;
  std::size_t wrong = 0;     ///< hit here, miss there
  double worst_value = 0.0;  ///< |f - h| at a hit over the range of values
};

/// A level set that lies in the box's own face is touched by rays just as they leave: a matter of the last bit, and of
/// whole plateaus only.
bool in_box_face(const Volume& volume, const Vec3& p) {
  const Vec3 last(volume.lattice().size - 1);
  const Vec3 margin = glm::min(p, last - p);
  return std::min({margin.x, margin.y, margin.z}) < 1e-6;
}

/// Every ray of the sites, answered by the wide kernels and by the oracle.
Disagreement compare(const Volume& volume, const Sites& sites, OuterSide outer, int rays = 64) {
  const LevelSetIntersector oracle(volume);
  const TrilinearField field(volume);
  const ValueRange range = value_range(volume);
  Disagreement result;
  std::mutex adding;
  const GatherSettings settings{.rays = rays, .outer = outer, .question = RayQuestion::kFirstHit};
  const TraceCounters counters = gather(volume, sites, settings, isolux::Run{}, [&](const GatheredRays& gathered) {
    Disagreement part;
    for (std::size_t i = 0; i < gathered.index_distance.size(); ++i) {
      const std::size_t site = gathered.sites[i / gathered.rays];
      const Vec3 origin(sites.positions[site]);
      const Vec3 direction(gathered.index_direction[0][i], gathered.index_direction[1][i],
                           gathered.index_direction[2][i]);
      const auto expected = oracle.next_hit(origin, direction, sites.isovalues[site], outer);
      ++part.rays;
      part.hits += std::size_t(expected.has_value());
      if (expected.has_value() == gathered.escaped(i) && !(expected && in_box_face(volume, expected->position)))
        ++part.wrong;
      if (gathered.escaped(i)) continue;
      const double t = double(gathered.index_distance[i]);
      const double off = std::abs(field.value(origin + t * direction) - double(sites.isovalues[site]));
      part.worst_value = std::max(part.worst_value, off / double(range.high - range.low));
    }
    const std::scoped_lock lock(adding);
    result.rays += part.rays;
    result.hits += part.hits;
    result.wrong += part.wrong;
    result.worst_value = std::max(result.worst_value, part.worst_value);
  });
  EXPECT_EQ(counters.rays, result.rays);
  EXPECT_EQ(result.rays, sites.size() * std::size_t(rays));
  return result;
}

Volume skewed_noise() {
  Volume volume = noise({14, 23, 9}, 5);
  Lattice lattice = volume.lattice();
  lattice.frame = {.origin = {3.0, -2.0, 5.0}, .axes = {{0.2, 0.02, 0.0}, {-0.1, 0.9, 0.3}, {0.0, -0.2, 3.0}}};
  volume.values =
      Grid<float>(lattice, std::vector<float>(volume.values.values().begin(), volume.values.values().end()));
  return volume;
}

/// A plateau of whole numbers, as 8-bit data have them: many corners equal an isovalue exactly.
Volume steps() {
  return unit_cube_volume(24, [](const Vec3& p) { return std::round(20.0 * std::sin(7.0 * p.x) * p.y + 6.0 * p.z); });
}

/// Bumps some cells wide, with noise upon them.
Volume coarse_noise() {
  const Volume bumps = noise({6, 6, 6}, 6);
  const TrilinearField field(bumps);
  RandomStream random(12, 0);
  return unit_cube_volume(41,
                          [&](const Vec3& p) { return field.value(8.0 * p) + 0.05 * (random.uniform_double() - 0.5); });
}

class WideKernel : public testing::TestWithParam<int64_t> {
 protected:
  void SetUp() override { choose_target(GetParam()); }
  void TearDown() override { choose_target(0); }
};

void expect_agreement(const Volume& volume, const char* name) {
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    for (const Place place : {Place::kAnywhere, Place::kOnFaces, Place::kBesideFaces, Place::kOnGridPoints}) {
      const Sites sites = random_sites(volume, 150 * stress(), place, outer);
      const Disagreement d = compare(volume, sites, outer);
      EXPECT_EQ(d.wrong, 0u) << name << ", place " << int(place) << ", " << d.rays << " rays, " << d.hits << " hits";
      // Single precision along a path of up to 64 voxels: 4e-6 of a voxel, with slopes of up to the range a voxel.
      EXPECT_LT(d.worst_value, 1e-4) << name;
      EXPECT_GT(d.hits, 0u) << name;
    }
  }
}

TEST_P(WideKernel, AgreesWithTheOracleOnSmoothFields) {
  expect_agreement(gyroid(40), "gyroid");
  expect_agreement(two_spheres(33), "two spheres");
}
TEST_P(WideKernel, AgreesWithTheOracleOnNoiseInASkewedFrame) { expect_agreement(skewed_noise(), "noise"); }
TEST_P(WideKernel, AgreesWithTheOracleOnPlateaus) { expect_agreement(steps(), "steps"); }
TEST_P(WideKernel, AgreesWithTheOracleInTheSmallestVolumes) {
  expect_agreement(noise({2, 2, 2}, 3), "one cell");
  expect_agreement(noise({2, 70, 3}, 4), "a thin slab");
}

/// Which rays of the sites hit, 64 a site.
struct Hits {
  std::vector<bool> hit;
  TraceCounters counters;
};

Hits hits_of(const Volume& volume, const Sites& sites, OuterSide outer, RayQuestion question) {
  Hits result{std::vector<bool>(64 * sites.size()), {}};
  isolux::Run run;
  run.threads = 1;  // neighbours of a vector of bits share a word
  result.counters =
      gather(volume, sites, {.rays = 64, .outer = outer, .question = question}, run, [&](const GatheredRays& gathered) {
        for (std::size_t i = 0; i < gathered.index_distance.size(); ++i)
          result.hit[gathered.sites[i / 64] * 64 + i % 64] = !gathered.escaped(i);
      });
  return result;
}

/// Any-hit answers, proofs among them, are those of the search for the first hit. Returns how many were proofs.
std::uint64_t expect_same_hits(const Volume& volume, const char* name) {
  std::uint64_t proven = 0;
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    for (const Place place : {Place::kAnywhere, Place::kOnFaces, Place::kBesideFaces}) {
      const Sites sites = random_sites(volume, 200 * stress(), place, outer);
      const Hits any = hits_of(volume, sites, outer, RayQuestion::kAnyHit);
      const Hits first = hits_of(volume, sites, outer, RayQuestion::kFirstHit);
      EXPECT_EQ(any.hit, first.hit) << name << ", outer side " << int(outer) << ", place " << int(place);
      EXPECT_EQ(any.counters.hits, first.counters.hits);
      EXPECT_EQ(any.counters.rays, first.counters.rays);
      EXPECT_LE(any.counters.proven, any.counters.hits);
      EXPECT_EQ(first.counters.proven, 0u) << "a proof does not tell where";
      proven += any.counters.proven;
    }
  }
  return proven;
}

/// The slope at the start is a hundred thousand times smaller than what brings rays back within the cell.
TEST_P(WideKernel, FindsTheWayBackOfRaysThatHardlyLeave) {
  const Volume volume =
      sampled({.size = Index3(2), .frame = {}}, [](const Vec3& p) { return p.z * (p.y * (4.0 * p.x - 1.0) - 1e-5); });
  const Sites sites{.positions = {Vec3f(0.0f)}, .isovalues = {0.0f}, .normals = {Vec3f(0.0f, 0.0f, 1.0f)}};
  const LevelSetIntersector oracle(volume);
  int hits = 0;
  (void)gather(volume, sites, {.rays = 1024}, isolux::Run{.threads = 1}, [&](const GatheredRays& gathered) {
    for (std::size_t i = 0; i < gathered.index_distance.size(); ++i) {
      const Vec3 way(gathered.index_direction[0][i], gathered.index_direction[1][i], gathered.index_direction[2][i]);
      const auto expected = oracle.next_hit(Vec3(0.0), way, 0.0f, OuterSide::kLower);
      ASSERT_EQ(expected.has_value(), !gathered.escaped(i));
      if (!expected) continue;
      ++hits;
      EXPECT_LT(std::abs(expected->t - double(gathered.index_distance[i])) * glm::length(way), 1e-4);  // as promised
    }
  });
  EXPECT_GT(hits, 100);
}

TEST_P(WideKernel, ProvesOnlyWhatHits) {
  // Small volumes, so that sites are told apart by isovalue: each bucket is to pay for itself.
  EXPECT_GT(expect_same_hits(gyroid(24), "gyroid"), 0u);
  EXPECT_GT(expect_same_hits(coarse_noise(), "coarse noise"), 0u);
  EXPECT_GT(expect_same_hits(steps(), "steps"), 0u);
  EXPECT_GT(expect_same_hits(two_spheres(33), "two spheres"), 0u);
  (void)expect_same_hits(skewed_noise(), "noise in a skewed frame");  // rarely 27 corners that agree
}

TEST_P(WideKernel, ProvesNothingWhereAllInsideIsBehind) {
  const Volume ball = unit_cube_volume(32, [](const Vec3& p) { return -glm::distance(p, Vec3(0.5)); });
  const Sites sites = random_sites(ball, 300, Place::kAnywhere, OuterSide::kLower);
  const Hits any = hits_of(ball, sites, OuterSide::kLower, RayQuestion::kAnyHit);
  EXPECT_EQ(any.counters.proven, 0u);
}

TEST_P(WideKernel, FindsWhatIsTooThinToProve) {
  // Walls a cell thick: no cube of 2^3 cells fits in, but rays are stopped.
  const Volume walls = unit_cube_volume(33, [](const Vec3& p) {
    return std::max(0.0, 1.0 - std::abs(32.0 * p.x - 8.5)) + std::max(0.0, 1.0 - std::abs(32.0 * p.x - 23.5));
  });
  const Sites sites = random_sites(walls, 300, Place::kAnywhere, OuterSide::kLower);
  const Hits any = hits_of(walls, sites, OuterSide::kLower, RayQuestion::kAnyHit);
  const Hits first = hits_of(walls, sites, OuterSide::kLower, RayQuestion::kFirstHit);
  EXPECT_EQ(any.hit, first.hit);
  EXPECT_GT(any.counters.hits, any.counters.rays / 8);  // those between the walls
  EXPECT_EQ(any.counters.proven, 0u);
}

INSTANTIATE_TEST_SUITE_P(EveryInstructionSet, WideKernel, testing::ValuesIn(wide_targets()), wide_target_name);

TEST(Gather, GivesTheSameBitsForAnyNumberOfThreads) {
  const Volume volume = gyroid(24);
  const Sites sites = random_sites(volume, 700, Place::kAnywhere, OuterSide::kLower);
  const auto distances = [&](int threads) {
    std::vector<float> all(sites.size() * 16);
    isolux::Run run;
    run.threads = threads;
    const auto keep = [&](const GatheredRays& gathered) {
      for (std::size_t i = 0; i < gathered.index_distance.size(); ++i)
        all[gathered.sites[i / 16] * 16 + i % 16] = gathered.index_distance[i];
    };
    EXPECT_EQ(gather(volume, sites, {.rays = 16}, run, keep).rays, all.size());
    return all;
  };
  EXPECT_EQ(distances(1), distances(3));
}

TEST(Gather, AnyHitAndFirstHitAgree) {
  const Volume volume = gyroid(24);
  const Sites sites = random_sites(volume, 300, Place::kAnywhere, OuterSide::kHigher);
  const auto hits = [&](RayQuestion question) {
    return gather(volume, sites, {.outer = OuterSide::kHigher, .question = question}, isolux::Run{},
                  [](const GatheredRays&) {})
        .hits;
  };
  EXPECT_EQ(hits(RayQuestion::kAnyHit), hits(RayQuestion::kFirstHit));
}

TEST(Gather, DirectionsAreCosineDistributedAboutTheNormal) {
  const Volume volume = gyroid(24);
  const Sites sites = random_sites(volume, 200, Place::kAnywhere, OuterSide::kLower);
  double sum = 0.0;
  std::atomic<int> below = 0;
  std::mutex adding;
  (void)gather(volume, sites, {}, isolux::Run{}, [&](const GatheredRays& gathered) {
    const std::scoped_lock lock(adding);
    for (std::size_t i = 0; i < gathered.index_distance.size(); ++i) {
      const Vec3 n(sites.normals[gathered.sites[i / gathered.rays]]);
      const Vec3 d(gathered.direction[0][i], gathered.direction[1][i], gathered.direction[2][i]);
      EXPECT_NEAR(glm::length(d), 1.0, 1e-5);  // single precision, some roundings
      sum += glm::dot(n, d);
      if (glm::dot(n, d) < 0.0) ++below;
    }
  });
  // The mean cosine of a cosine-weighted direction is 2/3; 12,800 stratified rays leave less than .1 % of noise.
  EXPECT_NEAR(sum / (200.0 * 64.0), 2.0 / 3.0, 1e-3);
  EXPECT_EQ(below, 0);
}

TEST(Gather, RefusesNoRays) {
  const Volume volume = gyroid(8);
  EXPECT_THROW((void)gather(volume, Sites{}, {.rays = 0}, isolux::Run{}, [](const GatheredRays&) {}), InvalidInput);
}

}  // namespace
}  // namespace isolux::test
