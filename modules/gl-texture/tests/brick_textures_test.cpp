#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <isolux/core/random.h>
#include <isolux/gl_texture.h>

#include <algorithm>
#include <array>
#include <vector>

#include "egl_context.h"
#include "texels_of.h"

namespace isolux {
namespace {

TEST(Atlas, HoldsEveryBrickInNearlyACube) {
  for (std::size_t count = 0; count < 3000; count += 7) {
    const Index3 n = atlas_size(count);
    const std::size_t room = std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z);
    EXPECT_GE(room, std::max<std::size_t>(count, 1));
    EXPECT_LT(room, count + std::size_t(n.x * n.y) + 1) << "at most the last layer is not full";
    EXPECT_LE(n.z, n.x);
  }
}

/// Bricks of random values on some of 3x2x4 pages.
LightBricks some_bricks(int channels) {
  LightBricks bricks;
  bricks.pages = {3, 2, 4};
  bricks.channels = channels;
  RandomStream random(1, 2);
  std::uint32_t count = 0;
  for (int page = 0; page < 24; ++page)
    bricks.slots.push_back(random.uniform_float() < 0.4f ? count++ : LightBricks::kAbsent);
  for (std::size_t i = 0; i < count * bricks.brick_size(); ++i) {
    bricks.values.push_back(random.uniform_float());
    bricks.slopes.push_back(random.uniform_float());
    for (auto& slopes : bricks.normal_slopes) slopes.push_back(random.uniform_float());
  }
  return bricks;
}

// float32 stores every bit.
TEST(BrickTextures, HaveEveryTexelOfABrickWhereItsPageSays) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  constexpr int kTexels = LightBricks::kTexels;
  for (const int channels : {1, 3}) {
    const LightBricks bricks = some_bricks(channels);
    ASSERT_GT(bricks.count(), 5u);
    const BrickTextures textures = upload_bricks(bricks, TexelFormat::kFloat32);
    std::vector<std::uint32_t> pages(bricks.slots.size());
    glBindTexture(GL_TEXTURE_3D, textures.pages.name());
    glGetTexImage(GL_TEXTURE_3D, 0, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, pages.data());
    const std::vector<float> values = test::texels_of(textures.values);
    const std::vector<float> slopes = test::texels_of(*textures.slopes);
    std::array<std::vector<float>, 3> normal_slopes;
    for (std::size_t a = 0; a < 3; ++a) normal_slopes[a] = test::texels_of(*textures.normal_slopes[a]);
    const Index3 n = textures.values.size();
    for (std::size_t p = 0; p < pages.size(); ++p) {
      if (bricks.slots[p] == LightBricks::kAbsent) {
        EXPECT_EQ(pages[p], 0u);
        continue;
      }
      ASSERT_EQ(pages[p] >> 30, 3u);
      const Index3 first = Index3(pages[p] & 1023u, pages[p] >> 10 & 1023u, pages[p] >> 20 & 1023u) * kTexels;
      std::size_t from = bricks.slots[p] * bricks.brick_size();
      for (int k = 0; k < kTexels; ++k)
        for (int j = 0; j < kTexels; ++j)
          for (int i = 0; i < kTexels; ++i)
            for (int c = 0; c < channels; ++c, ++from) {
              const Index3 t = first + Index3(i, j, k);
              const auto at = std::size_t(((t.z * n.y + t.y) * n.x + t.x) * channels + c);
              ASSERT_EQ(values[at], bricks.values[from]);
              ASSERT_EQ(slopes[at], bricks.slopes[from]);
              for (std::size_t a = 0; a < 3; ++a) ASSERT_EQ(normal_slopes[a][at], bricks.normal_slopes[a][from]);
            }
    }
    EXPECT_EQ(textures.bytes(), 4 * (pages.size() + values.size() + slopes.size() + 3 * normal_slopes[0].size()));
  }
}

TEST(BrickTextures, MayBeNone) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  LightBricks bricks;
  bricks.pages = {2, 2, 2};
  bricks.slots.assign(8, LightBricks::kAbsent);
  const BrickTextures textures = upload_bricks(bricks, TexelFormat::kFloat16);
  EXPECT_NE(textures.values.name(), 0u);
  EXPECT_FALSE(textures.slopes.has_value());
  EXPECT_FALSE(textures.normal_slopes[0].has_value());
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

}  // namespace
}  // namespace isolux
