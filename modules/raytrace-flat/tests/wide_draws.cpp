// Draws of the texel that the end of a ray reads.
#include <gtest/gtest.h>
#include <isolux/core/illumination_grid.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "analytic_volume.h"
#include "cell_sites.h"
#include "link_targets.h"
#include "wide/draw_corners.h"
#include "wide_targets.h"

namespace isolux::test {
namespace {

/// The share of each corner, in double precision.
std::array<double, 8> expected_weights(const Vec3& part, const std::array<float, 8>& away, bool by_isovalue) {
  double low = 0.0;
  double high = 0.0;
  for (const float a : away) {
    low = std::min(low, double(a));
    high = std::max(high, double(a));
  }
  std::array<double, 8> weights{};
  double sum = 0.0;
  for (unsigned q = 0; q < 8; ++q) {
    weights[q] = 1.0;
    for (unsigned a = 0; a < 3; ++a) weights[q] *= (q >> a & 1u) != 0 ? part[int(a)] : 1.0 - part[int(a)];
    if (by_isovalue) weights[q] *= std::pow(1.0 + std::pow(double(away[q]) / (0.06 * (high - low)), 2.0) / 8.0, -4.0);
    sum += weights[q];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

class Draws : public testing::TestWithParam<int64_t> {
 protected:
  void SetUp() override { choose_target(GetParam()); }
  void TearDown() override { choose_target(0); }
};

TEST_P(Draws, FollowTheWeights) {
  RandomStream random(5, 0);
  constexpr int kDraws = 16384;
  for (int place = 0; place < 12; ++place) {
    const Vec3 part(random.uniform_double(), random.uniform_double(), random.uniform_double());
    std::array<float, 8> away{};
    for (float& a : away) a = random.uniform_float() - 0.4f;
    for (const bool by_isovalue : {false, true}) {
      std::array<int, 8> count{};
      for (int d = 0; d < kDraws; d += int(wide::CornerDraws::kMost)) {
        wide::CornerDraws draws{};
        for (std::size_t lane = 0; lane < wide::CornerDraws::kMost; ++lane) {
          for (int a = 0; a < 3; ++a) draws.part[a][lane] = float(part[a]);
          for (auto& uniform : draws.uniform) uniform[lane] = random.uniform_float();
          for (std::size_t q = 0; q < 8; ++q) draws.away[q][lane] = away[q];
        }
        wide::draw_corners(draws, wide::CornerDraws::kMost, {.isovalue = by_isovalue});
        for (const std::uint32_t corner : draws.corner) ++count.at(corner);
      }
      const std::array<double, 8> expected = expected_weights(part, away, by_isovalue);
      // A standard deviation is .004 at most; four of them.
      for (std::size_t q = 0; q < 8; ++q) EXPECT_NEAR(double(count[q]) / kDraws, expected[q], 0.016);
    }
  }
}

TEST_P(Draws, AlwaysFindACornerThatIsPartOfThePlace) {
  // Isovalues all alike, alike to a rounding, and far from what they are weighed by; places on corners and faces.
  const float tiny = std::numeric_limits<float>::denorm_min();
  for (const float away : {0.0f, tiny, -tiny, 1e-30f, 1e30f, -1e30f}) {
    for (const float x : {0.0f, 1.0f}) {
      wide::CornerDraws draws{};
      for (std::size_t lane = 0; lane < wide::CornerDraws::kMost; ++lane) {
        draws.part[0][lane] = x;
        draws.part[1][lane] = 0.5f;
        draws.part[2][lane] = 1.0f;
        for (auto& uniform : draws.uniform) uniform[lane] = float(lane) / float(wide::CornerDraws::kMost);
        for (auto& corner : draws.away) corner[lane] = away;
        draws.away[7][lane] = 0.0f;
      }
      wide::draw_corners(draws, wide::CornerDraws::kMost, {.isovalue = true});
      for (const std::uint32_t corner : draws.corner) {
        EXPECT_EQ(corner & 1u, x > 0.0f ? 1u : 0u) << away;
        EXPECT_EQ(corner & 4u, 4u) << away;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, Draws, testing::ValuesIn(wide_targets()), wide_target_name);

/// The mean of what draws read at a place.
double mean_of_draws(const LinkTargets& targets, const Vec3& index, float isovalue, std::span<const float> light) {
  constexpr int kDraws = 20000;
  double sum = 0.0;
  for (int d = 0; d < kDraws; ++d) {
    std::vector<std::uint32_t> target;
    targets.append_targets(std::array{LinkTargets::End{.index = Vec3f(index), .ray = 5}}, {}, isovalue,
                           LinkTargets::draws_of(1, std::size_t(d)), target);
    sum += double(light[target.front()]);
  }
  return sum / kDraws;
}

/// A spread of at most .5 leaves .0035 in the mean of the draws; four times that.
constexpr double kDrawsTolerance = 0.014;

TEST(LinkTargets, DrawTexelsByTheirTrilinearWeights) {
  const Volume volume = cavity(9);
  const Lattice texels = cell_lattice(volume.lattice());
  const LinkTargets targets(volume, texels, LinkTargets::Weights::kTrilinear, isolux::Run{});
  ASSERT_FALSE(targets.are_sites());
  RandomStream random(3, 0);
  IlluminationGrid grid(texels, 1);
  for (float& value : grid.values) value = random.uniform_float();
  for (int place = 0; place < 20; ++place) {
    const Vec3 index = 1.0 + 6.0 * Vec3(random.uniform_double(), random.uniform_double(), random.uniform_double());
    EXPECT_NEAR(mean_of_draws(targets, index, 0.0f, grid.values), grid.at_index(index - 0.5).x, kDrawsTolerance);
  }
}

TEST(LinkTargets, DrawTexelsOfLikeIsovalue) {
  // A field that rises along x by 1 a cell: texels lie at .5, 1.5 and so on.
  const Volume volume = unit_cube_volume(9, [](const Vec3& p) { return 8.0 * p.x; });
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  const LinkTargets targets(volume, sites, cell_lattice(volume.lattice()), isolux::Run{});
  ASSERT_TRUE(targets.are_sites());
  // Halfway between texels whose isovalues are .5 to either side, and a tenth of the way: the level set of an isovalue
  // has the light of the texels that are near it in value, not in space.
  for (const double x : {4.0, 3.6}) {
    EXPECT_NEAR(mean_of_draws(targets, {x, 4.0, 4.0}, 3.5f, sites.isovalues), 3.5, 0.05);
    EXPECT_NEAR(mean_of_draws(targets, {x, 4.0, 4.0}, 4.5f, sites.isovalues), 4.5, 0.05);
  }
  // Isovalues far from all corners' decide nothing between them, and nothing fails.
  EXPECT_NEAR(mean_of_draws(targets, {4.0, 4.0, 4.0}, 1e6f, sites.isovalues), 4.0, 0.1);
}

TEST(LinkTargets, ReadTheNearestLitTexelWhereNoneIs) {
  const Volume volume = gyroid(9);
  std::vector<std::size_t> texel;
  Sites all = cell_sites(volume, OuterSide::kLower, texel);
  Sites one;
  one.positions = {Vec3f(2.5f)};
  one.isovalues = {0.0f};
  one.normals = {Vec3f(0.0f, 0.0f, 1.0f)};
  const LinkTargets targets(volume, one, cell_lattice(volume.lattice()), isolux::Run{});
  ASSERT_TRUE(targets.are_sites());
  std::vector<LinkTargets::End> ends;
  for (const Vec3f& place : all.positions) ends.push_back({.index = place, .ray = std::uint32_t(ends.size())});
  std::vector<std::uint32_t> found;
  targets.append_targets(ends, {}, 0.5f, {}, found);
  EXPECT_EQ(found, std::vector<std::uint32_t>(ends.size(), 0u));
}

}  // namespace
}  // namespace isolux::test
