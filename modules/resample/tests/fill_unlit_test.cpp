#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/core/random.h>
#include <isolux/resample/fill_unlit.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isolux {
namespace {

ResampledGrid unlit(Index3 size, int channels) {
  Lattice lattice{.size = size, .frame = {}};
  return {.grid = IlluminationGrid(lattice, channels), .lit = std::vector<std::uint8_t>(lattice.count(), 0)};
}

void light_texel(ResampledGrid& grid, std::size_t texel, float value) {
  grid.lit[texel] = 1;
  const auto channels = std::size_t(grid.grid.channels);
  for (std::size_t c = 0; c < channels; ++c) grid.grid.values[texel * channels + c] = value + float(c);
}

ResampledGrid randomly_lit(Index3 size, int channels, double share) {
  ResampledGrid grid = unlit(size, channels);
  for (std::size_t t = 0; t < grid.lit.size(); ++t) {
    RandomStream random(7, t);
    if (random.uniform_double() < share) light_texel(grid, t, 1.0f + random.uniform_float());
  }
  return grid;
}

TEST(FillUnlit, KeepsTheBitsOfLitTexels) {
  for (const double share : {0.01, 0.5, 1.0}) {
    const ResampledGrid before = randomly_lit({17, 9, 13}, 3, share);
    const IlluminationGrid after = fill_unlit(before, {});
    for (std::size_t t = 0; t < before.lit.size(); ++t) {
      if (before.lit[t] == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(after.values[3 * t + c], before.grid.values[3 * t + c]);
    }
  }
}

TEST(FillUnlit, NeverBleedsBlackNorBeyondTheLightThereIs) {
  for (const double share : {0.001, 0.05, 0.7}) {
    const IlluminationGrid after = fill_unlit(randomly_lit({23, 16, 11}, 1, share), {});
    const auto [low, high] = std::minmax_element(after.values.begin(), after.values.end());
    // Lit values lie in [1, 2), and means of them do.
    EXPECT_GE(*low, 1.0f);
    EXPECT_LE(*high, 2.0f);
  }
}

TEST(FillUnlit, SpreadsOneTexelOverAll) {
  ResampledGrid grid = unlit({9, 5, 7}, 3);
  light_texel(grid, 100, 0.3f);
  const IlluminationGrid after = fill_unlit(std::move(grid), {});
  for (std::size_t t = 0; t < after.lattice.count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(after.values[3 * t + c], 0.3f + float(c));
  }
}

TEST(FillUnlit, TakesTheLightOfTheNearestSide) {
  // Lit at the two ends of a long box: each half goes to its own end.
  ResampledGrid grid = unlit({32, 3, 3}, 1);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j) {
      light_texel(grid, grid.grid.lattice.offset(0, j, k), 1.0f);
      light_texel(grid, grid.grid.lattice.offset(31, j, k), 5.0f);
    }
  const IlluminationGrid after = fill_unlit(std::move(grid), {});
  for (int i = 0; i < 32; ++i) EXPECT_EQ(after.values[after.lattice.offset(i, 1, 1)], i < 16 ? 1.0f : 5.0f) << i;
}

TEST(FillUnlit, IsTheSameForAnyNumberOfThreads) {
  const ResampledGrid grid = randomly_lit({40, 41, 42}, 1, 0.01);
  const IlluminationGrid one = fill_unlit(grid, {.threads = 1});
  const IlluminationGrid four = fill_unlit(grid, {.threads = 4});
  EXPECT_EQ(one.values, four.values);
}

TEST(FillUnlit, RefusesAGridWithoutLight) { EXPECT_THROW((void)fill_unlit(unlit({3, 3, 3}, 1), {}), InvalidInput); }

}  // namespace
}  // namespace isolux
