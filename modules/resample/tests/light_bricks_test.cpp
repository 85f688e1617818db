#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/resample.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "support.h"

namespace isolux {
namespace {

using testing::make_volume;

Volume ball_volume() {
  return make_volume({24, 22, 20}, {1.0, 0.8, 1.5}, [](const Vec3& p) { return -glm::length(p - Vec3(11, 10, 9)); });
}

IlluminationGrid uneven_light(const Volume& volume, int channels, Index3 texels) {
  IlluminationGrid light(cell_lattice(volume.lattice(), texels), channels);
  light.detail.slopes.resize(light.values.size());
  for (std::size_t v = 0; v < light.values.size(); ++v) {
    light.values[v] = 0.3f + 0.01f * float(v * 7 % 31);
    light.detail.slopes[v] = 0.01f * float(v * 5 % 13);
  }
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t v = 0; v < light.values.size(); ++v)
      light.detail.normal_slopes[a].push_back(0.02f * float(v * (a + 3) % 11));
  light.detail.near_field = {{.step = 1.0f, .mean = 0.5f, .weight = Vec3f(0.1f)}};
  light.detail.isovalues = ValueRange{.low = -6.0f, .high = -5.5f};
  return light;
}

// The same sums in the same order: equal bits.
TEST(LightBricks, ReadAsTheWholeGridWithinTheRange) {
  const Volume volume = ball_volume();
  const TrilinearField field(volume);
  for (const int channels : {1, 3}) {
    for (const Index3 texels : {Index3(23, 21, 19), Index3(46, 42, 38), Index3(9, 30, 2)}) {
      const IlluminationGrid light = uneven_light(volume, channels, texels);
      const LightReader dense(volume, light);
      const LightReader sparse(volume, light, TexelStorage::kBricks);
      if (texels.z > 2) {
        ASSERT_NE(sparse.bricks(), nullptr);
        EXPECT_LT(sparse.bricks()->stored(), std::size_t(light.detail.numbers()) * light.values.size());
      }
      int inside = 0;
      for (std::uint64_t s = 0; s < 20000; ++s) {
        RandomStream random(3, s);
        Vec3 p;
        for (int a = 0; a < 3; ++a) p[a] = random.uniform_double() * (volume.lattice().size[a] - 1);
        const double h = field.value(p);
        if (h < -6.0 || h > -5.5) continue;
        ++inside;
        EXPECT_EQ(sparse.at_index(p), dense.at_index(p));
      }
      EXPECT_GT(inside, 100);
    }
  }
}

// One bright voxel at either side of a brick's edge: of the eight cells that it touches one alone has its corner in
// some of the bricks.
TEST(LightBricks, HoldCellsOfWhichOneCornerReachesTheRange) {
  constexpr ValueRange kFaint{.low = 0.001f, .high = 1.0f};
  for (int q = 0; q < 8; ++q) {
    const Vec3 bright(4 + q % 2, 4 + q / 2 % 2, 4 + q / 4);
    const Volume volume = make_volume({12, 12, 12}, Vec3(1.0), [&](const Vec3& p) { return p == bright ? 1.0 : 0.0; });
    const TrilinearField field(volume);
    IlluminationGrid light = uneven_light(volume, 1, {11, 11, 11});
    light.detail.isovalues = kFaint;
    const LightReader dense(volume, light);
    const LightReader sparse(volume, light, TexelStorage::kBricks);
    ASSERT_NE(sparse.bricks(), nullptr);
    for (std::uint64_t s = 0; s < 2000; ++s) {
      RandomStream random(9, s);
      const Vec3 p =
          bright - 1.0 + 2.0 * Vec3(random.uniform_double(), random.uniform_double(), random.uniform_double());
      if (field.value(p) < double(kFaint.low)) continue;
      EXPECT_EQ(sparse.at_index(p), dense.at_index(p)) << "voxel " << q;
    }
  }
}

TEST(LightBricks, AreNotMadeOfALightOfAllIsovalues) {
  const Volume volume = ball_volume();
  IlluminationGrid light = uneven_light(volume, 1, {23, 21, 19});
  light.detail.isovalues.reset();
  EXPECT_EQ(LightReader(volume, light, TexelStorage::kBricks).bricks(), nullptr);
  light.detail.isovalues = value_range(volume);
  EXPECT_EQ(LightReader(volume, light, TexelStorage::kBricks).bricks(), nullptr);
}

TEST(LightBricks, RepeatTheTexelsBetweenNeighbours) {
  const Volume volume = ball_volume();
  const IlluminationGrid light = uneven_light(volume, 1, {23, 21, 19});
  const LightBricks bricks = make_light_bricks(volume, light, {.low = -100.0f, .high = 0.0f});
  constexpr int kTexels = LightBricks::kTexels;
  const auto texel = [&](const Index3& page, const Index3& t) {
    const std::size_t at =
        ((std::size_t(bricks.slots[bricks.page_of(page)]) * kTexels + std::size_t(t.z)) * kTexels + std::size_t(t.y)) *
            kTexels +
        std::size_t(t.x);
    return bricks.values[at];
  };
  EXPECT_EQ(texel({0, 1, 1}, {4, 2, 3}), texel({1, 1, 1}, {0, 2, 3}));
  EXPECT_EQ(texel({0, 0, 0}, {1, 2, 3}), light.values[light.lattice.offset(1, 2, 3)]);
}

TEST(FillUnlit, LeavesTexelsBeyondItsLayersDark) {
  const Volume volume = testing::ramp_volume({10, 4, 4});
  ResampledGrid partial{.grid = IlluminationGrid(cell_lattice(volume.lattice()), 1), .lit = {}};
  partial.lit.assign(partial.grid.values.size(), 0);
  for (std::size_t t = 0; t < partial.lit.size(); t += 9) {
    partial.lit[t] = 1;
    partial.grid.values[t] = 0.5f;
  }
  const IlluminationGrid light = fill_unlit(partial, {}, {.layers = 2});
  for (std::size_t t = 0; t < light.values.size(); ++t) EXPECT_EQ(light.values[t], t % 9 <= 2 ? 0.5f : 0.0f);
}

TEST(LightBricks, AreNotMadeOfALightThatIsNotComplete) {
  const Volume volume = ball_volume();
  const ValueRange range{.low = -6.0f, .high = -5.5f};
  IlluminationGrid light = uneven_light(volume, 1, {23, 21, 19});
  EXPECT_NO_THROW((void)make_light_bricks(volume, light, range));
  light.detail.slopes.pop_back();
  EXPECT_THROW((void)make_light_bricks(volume, light, range), InvalidInput);
  light.detail.slopes.clear();
  light.detail.normal_slopes[2].resize(3);
  EXPECT_THROW((void)make_light_bricks(volume, light, range), InvalidInput);
  light.detail.normal_slopes = {};
  light.values.resize(3);
  EXPECT_THROW((void)make_light_bricks(volume, light, range), InvalidInput);
  EXPECT_THROW((void)make_light_bricks(volume, {}, range), InvalidInput);
}

}  // namespace
}  // namespace isolux
