// The exactness of the wide kernels at the size of real work. ISOLUX_STRESS=N takes N times as many rays, and volumes
// of 256^3 in place of 32^3; 100 for a million rays of each volume. ISOLUX_DATA adds real volumes.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/raytrace_flat/level_set_intersector.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "physics_support.h"
#include "stress.h"
#include "wide_targets.h"

namespace isolux::test {
namespace {

/// gen:NAME:N, larger in a campaign, or a file of ISOLUX_DATA.
struct Source {
  std::string name;
  bool is_file = false;
  int power = 0;       ///< of two, by which values are multiplied
  float spike = 0.0f;  ///< in the middle, instead of what is there
};

std::vector<Source> sources() {
  return {{.name = "gyroid"},
          {.name = "marschner-lobb"},
          {.name = "noise"},
          {.name = "noise", .power = 118},
          {.name = "noise", .power = -100},
          {.name = "noise", .spike = 1e30f},
          {.name = "bonsai", .is_file = true},
          {.name = "engine", .is_file = true}};
}

std::optional<Volume> volume_of(const Source& source) {
  if (!source.is_file) {
    Volume volume = read_volume("gen:" + source.name + (stress() > 1 ? ":256" : ":32"));
    for (float& value : volume.values.values()) value = std::ldexp(value, source.power);
    const Index3 middle = volume.lattice().size / 2;
    if (source.spike != 0.0f) volume.values(middle.x, middle.y, middle.z) = source.spike;
    return volume;
  }
  const char* folder = std::getenv("ISOLUX_DATA");
  if (folder == nullptr) return std::nullopt;
  const std::string path = std::string(folder) + "/" + source.name + ".nrrd";
  if (!std::filesystem::exists(path)) return std::nullopt;
  return read_volume(path);
}

/// Sites uniform in the box, of isovalues in [low, high].
Sites sites_between(const Volume& volume, std::size_t count, OuterSide outer, double low, double high) {
  const TrilinearField field(volume);
  const Vec3 extent(volume.lattice().size - 1);
  RandomStream random(23, 1);
  Sites sites;
  while (sites.size() < count) {
    const Vec3f p(Vec3(random.uniform_double(), random.uniform_double(), random.uniform_double()) * extent);
    const double value = field.value(Vec3(p));
    if (value < low || value > high) continue;
    const Vec3 normal = field.normal(Vec3(p), outer, GradientKind::kCentralDifferences);
    if (normal == Vec3(0.0)) continue;
    sites.positions.push_back(p);
    sites.isovalues.push_back(float(value));
    sites.normals.emplace_back(normal);
  }
  return sites;
}

Sites sites_anywhere(const Volume& volume, std::size_t count, OuterSide outer) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return sites_between(volume, count, outer, -kAny, kAny);
}

/// Sites of isovalues about as alike as in one of the 255 buckets of a bake: the `part`-th of 64 equal shares.
Sites sites_alike(const Volume& volume, std::size_t count, OuterSide outer, std::size_t part) {
  std::vector<float> values = sites_anywhere(volume, 6400, outer).isovalues;
  std::sort(values.begin(), values.end());
  return sites_between(volume, count, outer, double(values[part * 100]), double(values[part * 100 + 99]));
}

/// How the wide kernels' first hits compare with those of the double-precision oracle.
struct Comparison {
  std::size_t rays = 0;
  std::size_t hits = 0;
  std::size_t wrong = 0;      ///< hit here, miss there
  std::size_t elsewhere = 0;  ///< hits more than 1e-4 voxel apart
  double worst = 0.0;         ///< voxels
};

Comparison compare(const Volume& volume, const Sites& sites, int rays) {
  const LevelSetIntersector oracle(volume);
  Comparison sum;
  std::mutex adding;
  (void)gather(volume, sites, {.rays = rays}, isolux::Run{}, [&](const GatheredRays& gathered) {
    Comparison part;
    for (std::size_t i = 0; i < gathered.index_distance.size(); ++i) {
      const std::size_t site = gathered.sites[i / gathered.rays];
      const Vec3 direction(gathered.index_direction[0][i], gathered.index_direction[1][i],
                           gathered.index_direction[2][i]);
      const auto expected =
          oracle.next_hit(Vec3(sites.positions[site]), direction, sites.isovalues[site], OuterSide::kLower);
      ++part.rays;
      part.wrong += std::size_t(expected.has_value() == gathered.escaped(i));
      if (!expected || gathered.escaped(i)) continue;
      ++part.hits;
      const double apart = std::abs(expected->t - double(gathered.index_distance[i])) * glm::length(direction);
      part.worst = std::max(part.worst, apart);
      part.elsewhere += std::size_t(apart > 1e-4);
    }
    const std::scoped_lock lock(adding);
    sum.rays += part.rays;
    sum.hits += part.hits;
    sum.wrong += part.wrong;
    sum.elsewhere += part.elsewhere;
    sum.worst = std::max(sum.worst, part.worst);
  });
  return sum;
}

/// How any-hit answers compare with the oracle's.
struct AnyComparison {
  std::size_t rays = 0;
  std::size_t wrong = 0;
  std::size_t proven = 0;  ///< told without a search
};

void compare_any(const Volume& volume, const LevelSetIntersector& oracle, const Sites& sites, OuterSide outer,
                 AnyComparison& sum) {
  std::mutex adding;
  const GatherSettings settings{.rays = 64, .outer = outer, .question = RayQuestion::kAnyHit};
  const TraceCounters counters = gather(volume, sites, settings, isolux::Run{}, [&](const GatheredRays& gathered) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < gathered.index_distance.size(); ++i) {
      const std::size_t site = gathered.sites[i / gathered.rays];
      const Vec3 way(gathered.index_direction[0][i], gathered.index_direction[1][i], gathered.index_direction[2][i]);
      const auto expected = oracle.next_hit(Vec3(sites.positions[site]), way, sites.isovalues[site], outer);
      wrong += std::size_t(expected.has_value() == gathered.escaped(i));
    }
    const std::scoped_lock lock(adding);
    sum.wrong += wrong;
  });
  sum.rays += counters.rays;
  sum.proven += counters.proven;
}

void report(const std::string& line) {
  if (stress() > 1) std::cout << line << std::endl;
}

class WideCampaign : public testing::TestWithParam<int64_t> {
 protected:
  void SetUp() override { choose_target(GetParam()); }
  void TearDown() override { choose_target(0); }
};

TEST_P(WideCampaign, AgreesWithTheOracleOnVolumes) {
  for (const Source& source : sources()) {
    const auto volume = volume_of(source);
    if (!volume) continue;
    const Sites sites = sites_anywhere(*volume, std::size_t(stress() > 1 ? 160 * stress() : 40), OuterSide::kLower);
    const Comparison c = compare(*volume, sites, 64);
    EXPECT_EQ(c.wrong, 0u) << source.name << ", of " << c.rays << " rays";
    EXPECT_EQ(c.elsewhere, 0u) << source.name << ", of " << c.hits << " hits";
    RecordProperty(source.name, std::to_string(c.rays));
    report(fmt::format("{:<15} {} rays, {} hits, {} wrong, {} off by more than 1e-4 voxel, worst {:.1e}", source.name,
                       c.rays, c.hits, c.wrong, c.elsewhere, c.worst));
  }
}

/// Sites of 64 rays for which gather() makes the bits that proofs need: a ray for five cubes of 2^3 cells.
std::size_t enough_for_proofs(const Volume& volume) { return volume.lattice().count() / 8 / 5 / 64 + 1; }

/// Many hits are proven without a search where isovalues are alike.
TEST_P(WideCampaign, AgreesWithTheOracleWhereAnyHitIsAsked) {
  std::size_t proven = 0;
  for (const Source& source : sources()) {
    if (source.is_file && stress() == 1) continue;  // real volumes take seconds
    const auto volume = volume_of(source);
    if (!volume) continue;
    const LevelSetIntersector oracle(*volume);
    AnyComparison any;
    for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
      for (const std::size_t part : {15u, 31u, 47u, 60u}) {
        const std::size_t count = stress() > 1 ? std::max(std::size_t(20 * stress()), enough_for_proofs(*volume)) : 20;
        compare_any(*volume, oracle, sites_alike(*volume, count, outer, part), outer, any);
      }
    }
    EXPECT_EQ(any.wrong, 0u) << source.name << ", of " << any.rays << " rays, " << any.proven << " proven";
    report(fmt::format("{:<15} {} rays, any hit: {} wrong, {} proven", source.name, any.rays, any.wrong, any.proven));
    proven += any.proven;
  }
  EXPECT_GT(proven, 0u);
}

/// Closed spheres seen from inside: whoever gets out has leaked.
TEST_P(WideCampaign, NoRayLeavesAClosedLevelSet) {
  const Volume volume = read_volume("gen:cavity:96");
  const Vec3 centre(47.5);
  Sites all = sites_anywhere(volume, std::size_t(stress() > 1 ? 400 * stress() : 100), OuterSide::kLower);
  Sites closed;
  for (std::size_t i = 0; i < all.size(); ++i) {
    // Half a voxel from where they are open: the grid's interpolant is that far from the sphere at most.
    if (glm::distance(Vec3(all.positions[i]), centre) > 47.0) continue;
    closed.positions.push_back(all.positions[i]);
    closed.isovalues.push_back(all.isovalues[i]);
    closed.normals.push_back(all.normals[i]);
  }
  for (const RayQuestion question : {RayQuestion::kAnyHit, RayQuestion::kFirstHit}) {
    const TraceCounters counters =
        gather(volume, closed, {.rays = 64, .question = question}, isolux::Run{}, [](const GatheredRays&) {});
    EXPECT_EQ(counters.hits, counters.rays);
    report(fmt::format("closed spheres  {} rays, {} leaked", counters.rays, counters.rays - counters.hits));
  }
}

INSTANTIATE_TEST_SUITE_P(EveryInstructionSet, WideCampaign, testing::ValuesIn(wide_targets()), wide_target_name);

}  // namespace
}  // namespace isolux::test
