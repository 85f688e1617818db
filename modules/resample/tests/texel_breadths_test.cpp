#include "texel_breadths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support.h"

namespace isolux {
namespace {

/// Half the range of f in the cells that a texel's tent touches, looked for among all cells.
double breadth_by_all_cells(const Volume& volume, const Lattice& texels, const Index3& texel) {
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  const Vec3 low = to_volume.world(Vec3(texel - 1));
  const Vec3 high = to_volume.world(Vec3(texel + 1));
  const Index3 cells = volume.lattice().size - 1;
  float least = INFINITY;
  float most = -INFINITY;
  for (int k = 0; k < cells.z; ++k)
    for (int j = 0; j < cells.y; ++j)
      for (int i = 0; i < cells.x; ++i) {
        const Vec3 cell(i, j, k);
        bool touches = true;
        for (int a = 0; a < 3; ++a) touches = touches && cell[a] + 1.0 > low[a] + 1e-6 && cell[a] < high[a] - 1e-6;
        if (!touches) continue;
        for (int corner = 0; corner < 8; ++corner) {
          const float f = volume.values(i + corner % 2, j + corner / 2 % 2, k + corner / 4);
          least = std::min(least, f);
          most = std::max(most, f);
        }
      }
  return 0.5 * (double(most) - double(least));
}

TEST(TexelBreadths, AreHalfTheRangeOfTheCellsThatATentTouches) {
  const Volume volume = testing::make_volume({9, 8, 7}, {1.0, 0.5, 2.0}, [](const Vec3& p) {
    return RandomStream(2, std::uint64_t(p.x + 100.0 * p.y + 10000.0 * p.z)).uniform_double();
  });
  for (const Index3 size : {Index3(8, 7, 6), Index3(5, 7, 3), Index3(16, 3, 12)}) {
    const Lattice texels = cell_lattice(volume.lattice(), size);
    const TexelBreadths breadths(volume, texels);
    const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
    for (int k = 0; k < size.z; ++k)
      for (int j = 0; j < size.y; ++j)
        for (int i = 0; i < size.x; ++i)
          ASSERT_EQ(breadths.at(to_volume.world(Vec3(i, j, k))), breadth_by_all_cells(volume, texels, {i, j, k}));
  }
}

}  // namespace
}  // namespace isolux
