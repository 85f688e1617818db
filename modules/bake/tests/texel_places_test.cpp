// Positions of sites told by a bit a texel, and light found while the positions are gone.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "texel_places.h"

namespace isolux::test {
namespace {

/// Steps between plateaus: texels on these have no site.
Volume terraces() {
  Volume volume = read_volume("gen:sphere:16");
  for (float& value : volume.values.values()) value = value > -0.15f ? 3.0f : value > -0.4f ? value : -0.5f;
  return volume;
}

Sites sites_at(const Volume& volume, const Lattice& texels) {
  return samplers().create("texels")->sample(volume, {.texels = texels}, {});
}

TEST(TexelPlaces, GiveBackThePositionsToTheBit) {
  const Volume volume = terraces();
  for (const Lattice& texels :
       {cell_lattice(volume.lattice()), cell_lattice(volume.lattice(), {7, 40, 9}), voxel_lattice(volume.lattice())}) {
    const Sites sites = sites_at(volume, texels);
    ASSERT_LT(sites.size(), texels.count());
    const auto places = TexelPlaces::of(volume.lattice(), texels, sites.positions);
    ASSERT_TRUE(places.has_value());
    std::vector<Vec3f> positions;
    std::size_t texel = 0;
    while (positions.size() < sites.size()) {
      const std::vector<Vec3f> more = places->next(texel, 100);
      ASSERT_FALSE(more.empty());
      positions.insert(positions.end(), more.begin(), more.end());
    }
    EXPECT_EQ(positions, sites.positions);
    EXPECT_TRUE(places->next(texel, 1).empty());
  }
}

TEST(TexelPlaces, AreNoneOfPositionsThatAreNotTheTexelsInTheirOrder) {
  const Volume volume = terraces();
  const Lattice texels = cell_lattice(volume.lattice());
  std::vector<Vec3f> positions = sites_at(volume, texels).positions;
  std::swap(positions.front(), positions.back());
  EXPECT_FALSE(TexelPlaces::of(volume.lattice(), texels, positions));
  std::swap(positions.front(), positions.back());
  positions[5].x += 0.25f;
  EXPECT_FALSE(TexelPlaces::of(volume.lattice(), texels, positions));
}

TEST(KeptRays, LastLightIsTheLightToTheBitThoughPlacesAreLetGo) {
  const Volume volume = terraces();
  Scene scene;
  scene.environment = UniformEnvironment{{0.5f, 0.7f, 1.0f}};
  scene.albedo = {.keys = {{0.0f, Vec3f(0.8f, 0.5f, 0.3f)}}};
  BakeSettings settings;
  settings.trace.rays = 16;
  KeptRays kept(volume, scene, settings, builtin_stages(), {});
  KeptRays gone(volume, scene, settings, builtin_stages(), {});
  const BakeResult with = kept.light(scene, {});
  const BakeResult without = std::move(gone).last_light(scene, {});
  EXPECT_GT(with.unlit_texels, 0u);
  EXPECT_EQ(without.light.values, with.light.values);
  EXPECT_EQ(without.light.detail.near_field.size(), with.light.detail.near_field.size());
  // The last light's error is judged by paths as well.
  EXPECT_EQ(with.reading_error, 0.0);
  EXPECT_DOUBLE_EQ(without.rmse_estimate, std::hypot(with.rmse_estimate, without.reading_error));
  EXPECT_EQ(without.unlit_texels, with.unlit_texels);
  EXPECT_EQ(without.least_rays, 16u);
  EXPECT_EQ(without.most_rays, 16u);
}

}  // namespace
}  // namespace isolux::test
