// One voxel far beyond all others, as of a dead detector or metal in tomography: light away from it is as without it.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

#include "grid_index.h"

namespace isolux::test {
namespace {

constexpr int kSpikedSize = 16;
constexpr int kSpikeAt = 8;  // of each axis

Volume spiked_gyroid(float spike) {
  Volume volume = read_volume("gen:gyroid:" + std::to_string(kSpikedSize));
  if (spike > 0.0f) volume.values(kSpikeAt, kSpikeAt, kSpikeAt) = spike;
  return volume;
}

/// rms error at centres of cells that do not touch the voxels around the spike.
double error_away(float spike, const std::string& resampler, int bounces) {
  const Volume volume = spiked_gyroid(spike);
  BakeSettings settings;
  settings.resampler.name = resampler;
  settings.trace.bounces = bounces;
  const IlluminationGrid light = bake(volume, {}, settings, builtin_stages(), {}).light;
  BakeSettings exact;
  exact.trace = {.rays = 512, .bounces = bounces};
  exact.bounce_method = BounceMethod::kPaths;
  exact.resampler.settings = {{"near_field", "false"}};
  const IlluminationGrid truth = bake(volume, {}, exact, builtin_stages(), {.seed = 9}).light;
  const LightReader reader(volume, light);
  double squares = 0.0;
  int count = 0;
  for (std::size_t t = 0; t < truth.values.size(); ++t) {
    const Index3 cell = index_of(truth.lattice.size, t);
    const int off = std::max({std::abs(2 * cell.x + 1 - 2 * kSpikeAt), std::abs(2 * cell.y + 1 - 2 * kSpikeAt),
                              std::abs(2 * cell.z + 1 - 2 * kSpikeAt)});
    if (off <= 4) continue;
    squares += std::pow(double(reader.at_index(Vec3(cell) + 0.5).x) - double(truth.values[t]), 2.0);
    ++count;
  }
  return std::sqrt(squares / count);
}

// Of the points that texels are chosen by one in fifty lies beside the spike, and was all that counted.
TEST(Spike, LeavesTheNumberOfTexelsAsItIs) {
  const Stages stages = builtin_stages();
  BakeSettings settings;
  settings.trace.bounces = 0;
  const auto chosen = [&](float spike) { return choose_texels(spiked_gyroid(spike), {}, settings, 0.03, stages, {}); };
  const TexelChoice without = chosen(0.0f);
  for (const float spike : {3e4f, 1e12f}) {
    const TexelChoice with = chosen(spike);
    EXPECT_EQ(with.texels, without.texels) << spike;
    EXPECT_LT(std::fabs(with.error / without.error - 1.0), 0.2) << spike;
  }
}

// A fit's slopes are held down where f changes by less than 1e-4 of the volume's range, as floats must hold what is
// read of them: worth 5 percent. What openness is worth is off by the places about the spike, a hundredth of all:
// worth 10. It was 1.9 times as wrong, with bounces and without.
TEST(Spike, LeavesAFitAsRightAwayFromIt) {
  for (const int bounces : {0, kAllBounces}) {
    const double without = error_away(0.0f, "fit", bounces);
    for (const float spike : {3e4f, 1e6f, 1e12f})
      EXPECT_LT(error_away(spike, "fit", bounces), 1.2 * without) << spike << ", bounces " << bounces;
  }
}

}  // namespace
}  // namespace isolux::test
