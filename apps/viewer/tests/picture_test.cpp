#include "gl/picture.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/render/image.h>

#include "egl_context.h"
#include "gl_target.h"

namespace isolux::viewer {
namespace {

TEST(Picture, IsOnePictureOfManyTiles) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  constexpr int kWidth = 5000;
  constexpr int kHeight = 2100;
  int tiles = 0;
  const Image image = draw_picture(kWidth, kHeight, [&](const glm::ivec2& first) {
    ++tiles;
    glDisable(GL_SCISSOR_TEST);
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    // A white box over the corner of four tiles.
    glEnable(GL_SCISSOR_TEST);
    glScissor(2000 - first.x, 2030 - first.y, 100, 40);
    glClearColor(1.0f, 1.0f, 1.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
  });
  EXPECT_EQ(tiles, 6);
  ASSERT_EQ(image.width, kWidth);
  ASSERT_EQ(image.height, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool white = x >= 2000 && x < 2100 && kHeight - 1 - y >= 2030 && kHeight - 1 - y < 2070;
      ASSERT_EQ(image.at(x, y).x, white ? 1.0f : 0.0f) << x << " " << y;
    }
}

TEST(Picture, LeavesTheFramebufferThatWasBound) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  const Target target;
  GLint before = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
  static_cast<void>(draw_picture(3, 2, [](const glm::ivec2&) {}));
  GLint after = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &after);
  EXPECT_EQ(after, before);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST(Picture, SaysThatTheDriverDrawsNoneSoLarge) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  EXPECT_THROW(static_cast<void>(draw_picture(1 << 20, 1, [](const glm::ivec2&) {})), GlError);
}

}  // namespace
}  // namespace isolux::viewer
