// Sites in buckets of isovalues: so many that they are listed in several groups.
#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <set>
#include <vector>

#include "physics_support.h"
#include "wide/site_blocks.h"

namespace isolux::test {
namespace {

constexpr std::size_t kManySites = 300000;  // listed by groups of 131072 at most

Sites random_sites(const Volume& volume) {
  const TrilinearField field(volume);
  RandomStream random(7, 0);
  Sites sites;
  while (sites.size() < kManySites) {
    const Vec3 p = Vec3(volume.lattice().size - 1) *
                   Vec3(random.uniform_double(), random.uniform_double(), random.uniform_double());
    sites.positions.emplace_back(p);
    sites.isovalues.push_back(float(field.value(p)));
    sites.normals.emplace_back(0.0f, 0.0f, 1.0f);
  }
  return sites;
}

/// Each site once, in a bucket whose occupancy holds for its isovalue and whose proofs do; in how many buckets.
std::size_t expect_each_once(const Volume& volume, const Sites& sites, OuterSide outer, int threads) {
  std::vector<int> visits(sites.size(), 0);
  std::set<float> thresholds;
  std::mutex adding;
  const wide::BlockRequest request{.outer = outer};
  wide::for_each_block(volume, sites, request, {.threads = threads}, "", [&](const wide::SiteBlock& block) {
    const std::scoped_lock lock(adding);
    thresholds.insert(block.occupancy.threshold);
    for (const std::uint32_t site : block.sites) {
      ++visits[site];
      EXPECT_EQ(block.admitted(sites.isovalues[site]), sites.isovalues[site]);
      const float level = outer == OuterSide::kLower ? sites.isovalues[site] : -sites.isovalues[site];
      EXPECT_LT(level, block.inner.ceiling);
    }
  });
  EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), std::ptrdiff_t(sites.size()));
  return thresholds.size();
}

TEST(WideSiteBlocks, HoldEverySiteOnceHoweverManyThereAre) {
  const Volume volume = gyroid(24);
  const Sites sites = random_sites(volume);
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher})
    for (const int threads : {1, 3}) EXPECT_GT(expect_each_once(volume, sites, outer, threads), 100u);
}

}  // namespace
}  // namespace isolux::test
