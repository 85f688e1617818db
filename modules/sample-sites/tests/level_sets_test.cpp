#include <gtest/gtest.h>
#include <isolux/sample_sites.h>

#include <cmath>
#include <glm/common.hpp>
#include <map>

#include "test_volumes.h"

namespace isolux {
namespace {

Sites sample(const Volume& volume, const ValueRange& range, double per_texel) {
  const SiteRequest request{.texels = cell_lattice(volume.lattice()), .per_texel = per_texel, .isovalues = range};
  return samplers().create("level_sets")->sample(volume, request, {});
}

// Positions are floats: up to 16 voxels they are off by 1e-6 at most, times a gradient of at most 3.
TEST(LevelSets, LieOnTheOneIsovalueAsked) {
  const Volume volume =
      index_volume({15, 14, 13}, [](const Vec3& p) { return std::sin(p.x) + std::cos(0.7 * p.y) + 0.2 * p.z; });
  const Sites sites = sample(volume, {.low = 0.5f, .high = 0.5f}, 4.0);
  EXPECT_GT(sites.size(), 500u);
  for (const float h : sites.isovalues) EXPECT_NEAR(h, 0.5f, 4e-6f);
}

// A layer of cells holds all the values of the range and hence little of its volume beside the others.
TEST(LevelSets, AreAsManyInSteepCellsAsInGentleOnes) {
  const Volume volume =
      index_volume({9, 9, 9}, [](const Vec3& p) { return p.x < 4.5 ? 0.1 * p.x : 100.0 + 0.1 * p.x; });
  const Sites sites = sample(volume, {.low = 0.05f, .high = 101.0f}, 4.0);
  std::map<int, int> by_layer;
  for (const Vec3f& p : sites.positions) ++by_layer[int(p.x)];
  for (int layer = 1; layer < 8; ++layer) EXPECT_EQ(by_layer[layer], 4 * 64) << layer;
}

// On planes of x, y or z: along the others like random numbers, whose mean over n cells is off by .29 / sqrt(n).
TEST(LevelSets, AreSpreadOverTheSurfaceInACell) {
  for (int axis = 0; axis < 3; ++axis) {
    const Volume volume = index_volume({17, 17, 17}, [&](const Vec3& p) { return p[axis]; });
    const Sites sites = sample(volume, {.low = 3.5f, .high = 3.5f}, 16.0);
    ASSERT_EQ(sites.size(), 16u * 256u);
    Vec3 mean(0.0);
    for (const Vec3f& p : sites.positions) mean += Vec3(p - glm::floor(p)) / double(sites.size());
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(mean[a], 0.5, a == axis ? 0.0 : 0.02);
  }
}

TEST(LevelSets, NeedNoMoreThanOneSiteInACell) {
  const Volume volume = index_volume({9, 9, 9}, [](const Vec3& p) { return p.x; });
  EXPECT_EQ(sample(volume, {.low = 3.5f, .high = 3.5f}, 0.5).size(), 32u);
}

}  // namespace
}  // namespace isolux
