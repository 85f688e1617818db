#include <gtest/gtest.h>
#include <isolux/bake/bake.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <optional>

namespace isolux {
namespace {

BakeSettings fitted(const std::optional<ValueRange>& isovalues) {
  BakeSettings settings;
  settings.resampler.name = "fit";
  settings.isovalues = isovalues;
  return settings;
}

// However the user says how many texels there are, the fit keeps as many numbers of each and takes as many sites.
TEST(ResamplingChoice, IsTheSameForTexelsAndTexelsACell) {
  const Volume volume = read_volume("gen:gyroid:33");
  const Stages stages = builtin_stages();
  using Range = std::optional<ValueRange>;
  for (const Range& isovalues : {Range{}, Range{{-0.2f, 0.2f}}, Range{{0.1f, 0.1f}}}) {
    for (const int texels : {20, 32, 36, 40, 48, 64}) {
      BakeSettings by_texels = fitted(isovalues);
      by_texels.texels = Index3(texels);
      // As the command does, which names backends before it has the volume.
      by_texels = with_defaults(with_backends(by_texels, stages), volume.lattice(), stages);
      BakeSettings by_density = fitted(isovalues);
      by_density.texels_a_cell = double(texels) / 32.0;
      by_density = with_defaults(by_density, volume.lattice(), stages);
      EXPECT_EQ(by_texels.resampler.settings, by_density.resampler.settings) << texels;
      EXPECT_NEAR(by_texels.sites_a_cell, by_density.sites_a_cell, 1e-9) << texels;
    }
  }
}

// Where a size is chosen after backends are named.
TEST(ResamplingChoice, LeavesTexelsOpenUntilThereIsAVolume) {
  const BakeSettings named = with_backends(fitted({}), builtin_stages());
  EXPECT_EQ(named.texels_a_cell, 0.0);
  EXPECT_EQ(named.sites_a_cell, 0.0);
  EXPECT_TRUE(named.resampler.settings.empty());
}

// By the mean of the axes: 2 texels a cell on one axis and half a texel on another are one.
TEST(ResamplingChoice, CountsTexelsByTheirMean) {
  const Volume volume = read_volume("gen:gyroid:33");
  BakeSettings settings = fitted({});
  settings.texels = Index3(64, 16, 32);
  settings = with_defaults(settings, volume.lattice(), builtin_stages());
  EXPECT_EQ(settings.resampler.settings.count("normals"), 0u);
  EXPECT_NEAR(settings.texels_a_cell, 1.0, 1e-9);
}

// Fine texels tell no slopes: the memory is better spent on the texels themselves.
TEST(ResamplingChoice, DropsSlopesOfFineTexels) {
  const Volume volume = read_volume("gen:gyroid:9");
  BakeSettings settings = fitted({});
  settings.trace.rays = 1;
  settings.trace.bounces = 0;
  settings.texels = Index3(16);
  const LightDetail fine = bake(volume, {}, settings, builtin_stages(), {}).light.detail;
  EXPECT_TRUE(fine.slopes.empty());
  EXPECT_TRUE(fine.normal_slopes[0].empty());
  settings.texels = Index3(8);
  const LightDetail usual = bake(volume, {}, settings, builtin_stages(), {}).light.detail;
  EXPECT_FALSE(usual.slopes.empty());
  EXPECT_FALSE(usual.normal_slopes[0].empty());
}

}  // namespace
}  // namespace isolux
