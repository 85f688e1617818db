// Which texels the level sets of known isovalues are read from.
#include <gtest/gtest.h>
#include <isolux/core/field.h>
#include <isolux/core/random.h>
#include <isolux/core/texel_mask.h>

#include <algorithm>
#include <cmath>

namespace isolux::test {
namespace {

Volume noise_volume(const Index3& size) {
  Volume volume{.values = Grid<float>({.size = size, .frame = {.origin = Vec3(3, -2, 7), .axes = Mat3(0.5)}}),
                .name = {}};
  std::size_t i = 0;
  for (float& value : volume.values.values()) value = float(mix_bits(++i) % 1000) * 0.001f;
  return volume;
}

/// Texels that some place of the range, of many, is read from.
TEST(TexelMask, HoldsWhateverIsReadFrom) {
  const Volume volume = noise_volume({9, 7, 6});
  const TrilinearField field(volume);
  const ValueRange range{0.3f, 0.32f};
  for (const Index3& size : {Index3(8, 6, 5), Index3(3, 4, 2), Index3(17, 6, 11), Index3(1, 1, 1)}) {
    const Lattice texels = cell_lattice(volume.lattice(), size);
    const TexelMask mask = texels_read_by(volume, texels, range, isolux::Run{});
    const IndexToWorld to_texels = index_to_index(volume.lattice(), texels);
    TexelMask read(size);
    RandomStream random(1, 0, 0);
    for (int look = 0; look < 200000; ++look) {
      Vec3 place;
      for (int a = 0; a < 3; ++a) place[a] = random.uniform_double() * (volume.lattice().size[a] - 1);
      const double value = field.value(place);
      if (value < double(range.low) || value > double(range.high)) continue;
      const Vec3 at = to_texels.world(place);
      for (int q = 0; q < 8; ++q) {
        Index3 texel;
        for (int a = 0; a < 3; ++a) {
          const double x = within_axis(at[a], size[a]);
          texel[a] = std::min(int(x) + (q >> a & 1), size[a] - 1);
        }
        read.set(texels.offset(texel.x, texel.y, texel.z));
      }
    }
    for (std::size_t t = 0; t < texels.count(); ++t)
      if (read[t]) {
        EXPECT_TRUE(mask[t]) << t;
      }
    EXPECT_GE(mask.count(), read.count());
  }
}

TEST(TexelMask, LeavesOutWhatIsFarFromTheRange) {
  Volume volume = noise_volume({40, 8, 70});
  std::size_t i = 0;
  for (float& value : volume.values.values()) value = float(i++ % 40);  // rises along x
  const Lattice texels = cell_lattice(volume.lattice());
  const TexelMask mask = texels_read_by(volume, texels, {10.25f, 10.75f}, isolux::Run{});
  for (int z = 0; z < 69; ++z)
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 39; ++x) EXPECT_EQ(mask[texels.offset(x, y, z)], std::abs(x - 10) <= 1) << x;
  EXPECT_EQ(mask.count(), 3u * 7u * 69u);
}

TEST(TexelMask, IsTheSameForAnyNumberOfThreads) {
  const Volume volume = noise_volume({33, 20, 40});
  const Lattice texels = cell_lattice(volume.lattice(), {50, 19, 41});
  isolux::Run one;
  one.threads = 1;
  isolux::Run three;
  three.threads = 3;
  const TexelMask a = texels_read_by(volume, texels, {0.999f, 2.0f}, one);
  const TexelMask b = texels_read_by(volume, texels, {0.999f, 2.0f}, three);
  for (std::size_t t = 0; t < texels.count(); ++t) EXPECT_EQ(a[t], b[t]);
  EXPECT_LT(a.count(), texels.count());
  EXPECT_GT(a.count(), 0u);
}

}  // namespace
}  // namespace isolux::test
