// The sampler `texels`: ranges of isovalues together give what no range gives, on whatever lattice.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/sample_sites.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "test_volumes.h"

namespace isolux {
namespace {

struct Case {
  const char* name;
  Lattice texels;
};

/// Texels one a cell, fewer, more, at the voxels, and on axes that are not the volume's.
std::vector<Case> cases(const Lattice& volume) {
  Lattice turned = cell_lattice(volume, {6, 6, 6});
  const Mat3 axes = turned.frame.axes;
  turned.frame.axes = Mat3(0.8 * axes[0] + 0.6 * axes[1], -0.6 * axes[0] + 0.8 * axes[1], axes[2]);
  return {{"cells", cell_lattice(volume)},
          {"fewer", cell_lattice(volume, {5, 11, 3})},
          {"more", cell_lattice(volume, {40, 31, 25})},
          {"voxels", voxel_lattice(volume)},
          {"turned", turned}};
}

double waves(const Vec3& p) { return std::sin(0.7 * p.x) + std::cos(0.5 * p.y + 0.2) * std::sin(0.4 * p.z) + 100.0; }

TEST(TexelSampler, GivesByRangesTheSitesThatItGivesOfAll) {
  const Volume volume = index_volume({21, 17, 11}, waves);
  const auto sampler = samplers().create("texels");
  for (const Case& of : cases(volume.lattice())) {
    SiteRequest request{.texels = of.texels};
    const Sites all = sampler->sample(volume, request, {});
    ASSERT_GT(all.size(), 0u) << of.name;
    // The least and the largest value that each range may have are isovalues of sites.
    std::vector<float> ends{-std::numeric_limits<float>::infinity()};
    for (std::size_t i = 0; i < all.size(); i += 1 + all.size() / 9) ends.push_back(all.isovalues[i]);
    std::sort(ends.begin(), ends.end());
    ends.push_back(std::numeric_limits<float>::infinity());
    std::size_t count = 0;
    for (std::size_t r = 0; r + 1 < ends.size(); ++r) {
      const float high = std::nextafter(ends[r + 1], ends[r]);
      request.isovalues = ValueRange{.low = ends[r], .high = r + 2 < ends.size() ? high : ends[r + 1]};
      const Sites some = sampler->sample(volume, request, {});
      std::size_t next = 0;
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (!(all.isovalues[i] >= request.isovalues->low && all.isovalues[i] <= request.isovalues->high)) continue;
        ASSERT_LT(next, some.size()) << of.name;
        EXPECT_EQ(some.positions[next], all.positions[i]) << of.name;
        EXPECT_EQ(some.isovalues[next], all.isovalues[i]) << of.name;
        EXPECT_EQ(some.normals[next], all.normals[i]) << of.name;
        ++next;
      }
      EXPECT_EQ(next, some.size()) << of.name;
      count += next;
    }
    EXPECT_EQ(count, all.size()) << of.name;
  }
}

// At voxels beside the box's faces a mask may have no gradient, and a little off them one that is rounding alone.
TEST(TexelSampler, LightsTheSameVoxelsOfAMaskWhateverItsAxes) {
  const auto sites_with = [](const IndexToWorld& frame) {
    Volume volume = index_volume({12, 12, 12}, [](const Vec3& p) {
      return double(int(p.x * 5.0 + p.y * 3.0 + p.z * 7.0 + p.x * p.y) % 11 < 2);
    });
    const std::span<const float> values = volume.values.values();
    volume.values = Grid<float>({.size = Index3(12), .frame = frame}, std::vector<float>(values.begin(), values.end()));
    const SiteRequest request{.texels = voxel_lattice(volume.lattice())};
    return samplers().create("texels")->sample(volume, request, isolux::Run{}).positions;
  };
  const std::vector<Vec3f> straight = sites_with({});
  EXPECT_LT(straight.size(), 12u * 12u * 12u);
  for (const double unit : {1.0, 3.0, 1e-6, 1e6}) {
    const Mat3 axes = Mat3(1.0, 0.1, 0.0, 0.0, 0.6, 0.2, 0.1, 0.0, 1.7) * unit;
    EXPECT_EQ(sites_with({.origin = Vec3(3.0, -4.0, 5.0) * unit, .axes = axes}), straight) << unit;
  }
}

TEST(TexelSampler, RefusesAMaskOfAnotherGrid) {
  const Volume volume = index_volume({9, 9, 9}, waves);
  SiteRequest request{.texels = cell_lattice(volume.lattice())};
  request.only = std::make_shared<const TexelMask>(Index3(8, 8, 7));
  EXPECT_THROW((void)samplers().create("texels")->sample(volume, request, {}), InvalidInput);
}

}  // namespace
}  // namespace isolux
