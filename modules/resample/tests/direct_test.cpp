#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/resample.h>

#include "support.h"

namespace isolux {
namespace {

using testing::add_sample;
using testing::ramp_volume;

SampleSet one_a_texel(const Volume& volume, const Lattice& texels) {
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  SampleSet set;
  for (int k = 0; k < texels.size.z; ++k)
    for (int j = 0; j < texels.size.y; ++j)
      for (int i = 0; i < texels.size.x; ++i) {
        const auto v = float(texels.offset(i, j, k));
        add_sample(set, volume, to_volume.world(Vec3(i, j, k)), {v, v + 0.25f, v + 0.5f});
      }
  return set;
}

TEST(Direct, PutsEachSampleAtItsTexel) {
  const Volume volume = ramp_volume({5, 6, 7}, {0.5, 1.0, 2.5});
  for (const Index3 size : {Index3(4, 5, 6), Index3(9, 3, 7), Index3(1, 1, 1)}) {
    const Lattice texels = cell_lattice(volume.lattice(), size);
    const SampleSet samples = one_a_texel(volume, texels);
    const ResampledGrid result = resamplers().create("direct")->resample(volume, samples, texels, {});
    EXPECT_EQ(result.grid.values, samples.radiance);
    EXPECT_EQ(result.lit, std::vector<std::uint8_t>(texels.count(), 1));
  }
}

TEST(Direct, LeavesTexelsWithoutSampleUnlit) {
  const Volume volume = ramp_volume({4, 4, 4});
  SampleSet samples;
  add_sample(samples, volume, {1.5, 0.5, 2.5}, {3.0f});
  const Lattice texels = cell_lattice(volume.lattice());
  const ResampledGrid result = resamplers().create("direct")->resample(volume, samples, texels, {});
  for (std::size_t t = 0; t < texels.count(); ++t) EXPECT_EQ(result.lit[t], t == texels.offset(1, 0, 2) ? 1 : 0);
  EXPECT_EQ(result.grid.values[texels.offset(1, 0, 2)], 3.0f);
}

TEST(Direct, AveragesSamplesAtOneTexel) {
  const Volume volume = ramp_volume({3, 3, 3});
  SampleSet samples;
  for (const float v : {1.0f, 2.0f, 6.0f}) add_sample(samples, volume, {0.5, 0.5, 0.5}, {v});
  const ResampledGrid result =
      resamplers().create("direct")->resample(volume, samples, cell_lattice(volume.lattice()), {});
  EXPECT_FLOAT_EQ(result.grid.values[0], 3.0f);
}

TEST(Direct, RefusesScatteredSamples) {
  const Volume volume = ramp_volume({3, 3, 3});
  for (const Vec3 p : {Vec3(0.5, 0.5, 0.6), Vec3(0.0, 0.5, 0.5)}) {
    SampleSet samples;
    add_sample(samples, volume, p, {1.0f});
    EXPECT_THROW((void)resamplers().create("direct")->resample(volume, samples, cell_lattice(volume.lattice()), {}),
                 InvalidInput);
  }
}

}  // namespace
}  // namespace isolux
