#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/gl_texture/texture_mapping.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

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

// A ramp sampled at the texel centres and filtered linearly gives itself back between the outermost centres if, and
// only if, texture coordinates hit the centres: the half texel, at any ratio of texels to cells and a different one an
// axis.
TEST(TextureMapping, ReproducesRampsAtAnyRatioOfTexelsToCells) {
  const Lattice volume = oblique_volume({9, 13, 25});
  const auto ramp = [](const Vec3& world) { return 0.7 * world.x - 1.3 * world.y + 0.2 * world.z; };
  std::vector<Lattice> lattices{voxel_lattice(volume)};
  for (const Vec3 ratio : {Vec3(0.5), Vec3(1.0), Vec3(1.5), Vec3(2.0), Vec3(3.0), Vec3(0.5, 1.75, 3.0)})
    lattices.push_back(cell_lattice(volume, Index3(Vec3(volume.size - 1) * ratio)));
  for (const Lattice& texels : lattices) {
    const TextureMapping mapping = texture_mapping(texels, volume);
    for (const Vec3 place : {Vec3(0.3, 0.5, 0.7), Vec3(0.21, 0.77, 0.4), Vec3(0.5)}) {
      // Linear filtering as OpenGL defines it: u N - 1/2 lies between two texels.
      const Vec3 at = (mapping.scale * place + mapping.offset) * Vec3(texels.size) - 0.5;
      const Index3 low(glm::floor(at));
      double read = 0.0;
      for (int q = 0; q < 8; ++q) {
        const Index3 step(q & 1, q >> 1 & 1, q >> 2);
        const Vec3 part = glm::mix(1.0 - (at - Vec3(low)), at - Vec3(low), Vec3(step));
        read += part.x * part.y * part.z * ramp(texels.frame.world(Vec3(low + step)));
      }
      // Double rounding some hundred steps from the origin.
      EXPECT_NEAR(read, ramp(volume.frame.world(place * Vec3(volume.size - 1))), 1e-9) << texels.size.x;
    }
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

// By a thousandth of a texel at the box's far end.
TEST(TextureMapping, ForgivesNoShearThatCanBeSeen) {
  const Lattice volume = oblique_volume({4, 9, 25});
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      if (a == b) continue;
      const auto sheared = [&](double drift) {
        Lattice texels = voxel_lattice(volume);
        texels.frame.axes[b] += drift / (volume.size[b] - 1) * texels.frame.axes[a];
        return texels;
      };
      EXPECT_NO_THROW(static_cast<void>(texture_mapping(sheared(0.95e-3), volume))) << a << b;
      EXPECT_THROW(static_cast<void>(texture_mapping(sheared(1.05e-3), volume)), InvalidInput) << a << b;
    }
  }
}

TEST(TextureMapping, RefusesAVolumeThatIsFlat) {
  const Lattice volume = oblique_volume({4, 1, 6});
  EXPECT_THROW(static_cast<void>(texture_mapping(volume, volume)), InvalidInput);
}

}  // namespace
}  // namespace isolux
