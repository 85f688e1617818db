// Maps between lattices of one box.
#include <gtest/gtest.h>
#include <isolux/core/lattice.h>

#include <cstddef>
#include <glm/geometric.hpp>
#include <vector>

namespace isolux {
namespace {

/// Oblique, turned and straight axes, in several units, some of them far away and some of very unlike lengths.
std::vector<IndexToWorld> frames() {
  const Mat3 oblique(1.0, 0.1, 0.0, 0.0, 0.6, 0.2, 0.1, 0.0, 1.7);
  const Vec3 origin(3.0, -4.0, 5.0);
  std::vector<IndexToWorld> all;
  for (const double unit : {1.0, 3.0, 1.0 / 7.0, 1e-12, 1e-6, 1e6, 1e12})
    all.push_back({.origin = origin * unit, .axes = oblique * unit});
  all.push_back({.origin = origin * 1e6, .axes = oblique});
  all.push_back({.origin = origin, .axes = Mat3(0.8, 0.6, 0.0, -0.6, 0.8, 0.0, 0.0, 0.0, 1.0)});
  all.push_back({.origin = origin, .axes = Mat3(0.0, 0.7, 0.0, 0.0, 0.0, -0.3, 1.1, 0.0, 0.0)});
  all.push_back({.origin = Vec3(0.0), .axes = Mat3(1.0, 0.1, 0.3, 1e-5, 2e-5, 1e-5, 300.0, 20.0, 500.0)});
  return all;
}

/// Whether `map` takes each point of a lattice to itself plus `shift`, as floats, which sites are.
void expect_shift(const IndexToWorld& map, const Index3& size, float shift, std::size_t frame) {
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) {
        const Vec3f place(map.world(Vec3(i, j, k)));
        ASSERT_EQ(place, Vec3f(i, j, k) + shift) << "frame " << frame << " at " << i << ' ' << j << ' ' << k;
      }
}

TEST(IndexToIndex, PutsTexelsAtVoxelsAndCellCentresWhateverTheFrame) {
  for (std::size_t f = 0; f < frames().size(); ++f) {
    const Lattice volume{.size = {20, 33, 9}, .frame = frames()[f]};
    const Lattice voxels = voxel_lattice(volume);
    const Lattice cells = cell_lattice(volume);
    expect_shift(index_to_index(voxels, volume), voxels.size, 0.0f, f);
    expect_shift(index_to_index(cells, volume), cells.size, 0.5f, f);
    expect_shift(index_to_index(volume, cells), volume.size, -0.5f, f);
  }
}

// One texel for three cells.
TEST(IndexToIndex, StepsOverCellsWhateverTheFrame) {
  for (std::size_t f = 0; f < frames().size(); ++f) {
    const Lattice volume{.size = {22, 28, 10}, .frame = frames()[f]};
    const Lattice thirds = cell_lattice(volume, (volume.size - 1) / 3);
    const IndexToWorld to_volume = index_to_index(thirds, volume);
    const IndexToWorld to_thirds = index_to_index(volume, thirds);
    for (int a = 0; a < 3; ++a) {
      Vec3 along(0.0);
      along[a] = 1.0;
      // Of the quotient's rounding.
      EXPECT_LE(glm::length(to_volume.axes[a] - 3.0 * along), 1e-15) << f;
      EXPECT_LE(glm::length(to_thirds.axes[a] - along / 3.0), 1e-15) << f;
    }
  }
}

TEST(IndexToIndex, TakesTheWayOverTheWorldBetweenAxesThatAreNotShared) {
  const Lattice volume{.size = {20, 33, 9}, .frame = frames()[0]};
  Lattice turned = volume;
  turned.frame.axes[1] += 1e-9 * turned.frame.axes[0];
  EXPECT_NEAR(index_to_index(turned, volume).axes[1].x, 1e-9, 1e-15);
  turned.frame = frames()[8];
  const Vec3 there = index_to_index(turned, volume).world({3.0, 7.0, 2.0});
  EXPECT_LE(glm::distance(there, volume.frame.index(turned.frame.world({3.0, 7.0, 2.0}))), 1e-13);
}

}  // namespace
}  // namespace isolux
