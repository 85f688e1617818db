#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/gl_texture/texture_mapping.h>

#include <array>
#include <cmath>

namespace isolux {
namespace {

/// An oblique, anisotropic frame: the mapping must not depend on it.
Lattice oblique_volume(Index3 size) {
  return {.size = size,
          .frame = {.origin = {12.5, -340.0, 7.25}, .axes = Mat3({0.8, 0.6, 0.0}, {-1.2, 1.6, 0.0}, {0.3, 0.2, 5.0})}};
}

TEST(TextureMapping, IsTheIdentityForTexelsAtCellCentres) {
  const Lattice volume = oblique_volume({5, 9, 33});
  for (const Index3 texels : {Index3(4, 8, 32), Index3(7, 3, 50), Index3(1, 1, 1)}) {
    const TextureMapping mapping = texture_mapping(cell_lattice(volume, texels), volume);
    for (int a = 0; a < 3; ++a) {
      // Double rounding of a 3x3 inverse of world coordinates some hundred steps from the origin.
      EXPECT_NEAR(mapping.scale[a], 1.0, 1e-12);
      EXPECT_NEAR(mapping.offset[a], 0.0, 1e-12);
    }
  }
}

TEST(TextureMapping, IsTheHalfTexelCorrectionForTexelsAtTheVoxels) {
  const Lattice volume = oblique_volume({2, 9, 33});
  const TextureMapping mapping = texture_mapping(voxel_lattice(volume), volume);
  for (int a = 0; a < 3; ++a) {
    const double n = volume.size[a];
    for (const double place : {0.0, 0.3, 1.0})
      EXPECT_NEAR(mapping.scale[a] * place + mapping.offset[a], (place * (n - 1) + 0.5) / n, 1e-12);
  }
}

TEST(TextureMapping, FollowsTexelsThatRunBackwards) {
  const Lattice volume = oblique_volume({4, 5, 6});
  Lattice texels = voxel_lattice(volume);
  texels.frame.origin += texels.frame.axes[1] * 4.0;
  texels.frame.axes[1] *= -1.0;
  const TextureMapping mapping = texture_mapping(texels, volume);
  EXPECT_NEAR(mapping.offset.y, 4.5 / 5.0, 1e-12);
  EXPECT_NEAR(mapping.scale.y + mapping.offset.y, 0.5 / 5.0, 1e-12);
}

TEST(TextureMapping, ForgivesTheRoundingOfFileHeadersButNoOtherAxes) {
  const Lattice volume = oblique_volume({40, 50, 60});
  Lattice texels = cell_lattice(volume);
  for (int a = 0; a < 3; ++a) texels.frame.axes[a] = Vec3(Vec3f(texels.frame.axes[a]));
  EXPECT_NO_THROW(static_cast<void>(texture_mapping(texels, volume)));
  std::swap(texels.frame.axes[0], texels.frame.axes[1]);
  EXPECT_THROW(static_cast<void>(texture_mapping(texels, volume)), InvalidInput);
  texels.frame.axes = Mat3(0.0);
  EXPECT_THROW(static_cast<void>(texture_mapping(texels, volume)), InvalidInput);
}

TEST(TextureMapping, RefusesAVolumeThatIsFlat) {
  const Lattice volume = oblique_volume({4, 1, 6});
  EXPECT_THROW(static_cast<void>(texture_mapping(volume, volume)), InvalidInput);
}

}  // namespace
}  // namespace isolux
