// Texels with a little more contrast than light has there, which reading between them takes away.
#include "sharpen.h"

#include <gtest/gtest.h>
#include <isolux/resample/resampler.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace isolux {
namespace {

constexpr int kSize = 24;

IlluminationGrid grid_of(const std::function<float(int, int, int)>& light) {
  IlluminationGrid grid = unlit_grid({.size = Index3(kSize), .frame = {}}, 1);
  for (int k = 0; k < kSize; ++k)
    for (int j = 0; j < kSize; ++j)
      for (int i = 0; i < kSize; ++i) grid.values[grid.lattice.offset(i, j, k)] = light(i, j, k);
  return grid;
}

IlluminationGrid sharpened(IlluminationGrid light, int threads = 0) {
  IlluminationGrid before = light;
  for (float& e : before.values) e += 1.0f;  // every texel has been denoised
  Run run;
  run.threads = threads;
  sharpen(light, before, run);
  return light;
}

TEST(Sharpen, LeavesLinearLight) {
  const IlluminationGrid light = grid_of([](int i, int j, int k) { return 1.0f + 0.25f * float(i + 2 * j + 3 * k); });
  EXPECT_EQ(sharpened(light).values, light.values);
}

TEST(Sharpen, PutsNoFringesWhereLightJumps) {
  const IlluminationGrid light = grid_of([](int i, int j, int) { return i < 9 ? 1.0f : (j < 12 ? 3.0f : 0.25f); });
  EXPECT_EQ(sharpened(light).values, light.values);
}

/// Read halfway between texels along x, at the middle of the others: mean squared error.
double error_between(const IlluminationGrid& grid, const std::function<float(double)>& light) {
  double sum = 0.0;
  for (int i = 4; i < kSize - 5; ++i) {
    const double read = 0.5 * (double(grid.values[grid.lattice.offset(i, 12, 12)]) +
                               double(grid.values[grid.lattice.offset(i + 1, 12, 12)]));
    sum += std::pow(read - double(light(i + 0.5)), 2.0);
  }
  return sum;
}

TEST(Sharpen, MakesReadingBetweenTexelsLessWrong) {
  const auto wave = [](double x) { return float(2.0 + std::sin(0.9 * x)); };
  const IlluminationGrid light = grid_of([&](int i, int, int) { return wave(i); });
  EXPECT_LT(error_between(sharpened(light), wave), 0.6 * error_between(light, wave));
}

TEST(Sharpen, RaisesRidgesThatReadingBlunts) {
  const IlluminationGrid light = grid_of([](int i, int, int) { return 4.0f - 0.25f * std::fabs(float(i - 12)); });
  const IlluminationGrid sharp = sharpened(light);
  for (int i = 0; i < kSize; ++i) {
    const std::size_t at = light.lattice.offset(i, 12, 12);
    if (i == 12)
      EXPECT_GT(sharp.values[at], light.values[at] + 0.01f);
    else
      EXPECT_EQ(sharp.values[at], light.values[at]);
  }
}

// It looks at two texels to either side: those nearer to the end stay.
TEST(Sharpen, ReachesTheThirdTexelFromEitherEnd) {
  for (const int ridge : {1, 2, kSize - 3, kSize - 2}) {
    const auto falling = [&](int at) { return 8.0f - 0.25f * std::fabs(float(at - ridge)); };
    const IlluminationGrid x = sharpened(grid_of([&](int i, int, int) { return falling(i); }));
    const IlluminationGrid z = sharpened(grid_of([&](int, int, int k) { return falling(k); }));
    const bool is_reached = ridge >= 2 && ridge < kSize - 2;
    EXPECT_EQ(x.values[x.lattice.offset(ridge, 12, 12)] > 8.0f, is_reached) << ridge;
    EXPECT_EQ(z.values[z.lattice.offset(12, 12, ridge)] > 8.0f, is_reached) << ridge;
  }
}

TEST(Sharpen, LooksAtLitNeighboursAlone) {
  IlluminationGrid light = grid_of([](int i, int j, int k) { return float((i * i + j * j + k * k) % 7); });
  const std::size_t hole = light.lattice.offset(12, 12, 12);
  light.values[hole] = std::numeric_limits<float>::quiet_NaN();
  const IlluminationGrid sharp = sharpened(light);
  EXPECT_TRUE(std::isnan(sharp.values[hole]));
  EXPECT_EQ(std::count_if(sharp.values.begin(), sharp.values.end(), [](float e) { return std::isnan(e); }), 1);
  EXPECT_GE(*std::min_element(sharp.values.begin(), sharp.values.begin() + 100), 0.0f);
}

TEST(Sharpen, LeavesTexelsThatNothingWasTakenFrom) {
  const IlluminationGrid light = grid_of([](int i, int, int) { return 2.0f + std::sin(0.9f * float(i)); });
  IlluminationGrid sharp = light;
  sharpen(sharp, light, {});
  EXPECT_EQ(sharp.values, light.values);
}

TEST(Sharpen, MakesTheSameBitsForAnyNumberOfThreads) {
  const IlluminationGrid light = grid_of([](int i, int j, int k) { return float((i * 7 + j * j + k * i) % 11); });
  EXPECT_EQ(sharpened(light, 1).values, sharpened(light, 2).values);
}

}  // namespace
}  // namespace isolux
