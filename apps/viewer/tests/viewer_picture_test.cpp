// What the viewer draws.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <isolux/render/image.h>

#include <vector>

#include "gl/picture.h"
#include "viewer_fixture.h"

namespace isolux::viewer {
namespace {

using testing::Contains;
using testing::HasSubstr;

// Before update() takes it the surface that was asked for is not shown, however soon it is made.
TEST_F(ViewerTest, SavesThePictureOfTheSurfaceAskedFor) {
  look([](ViewerSettings&) {});
  viewer_->act(Action::kIsovalueFarUp);
  viewer_->act(Action::kScreenshot);
  EXPECT_FALSE(viewer_->take_screenshot_request());
  rest();
  EXPECT_TRUE(viewer_->take_screenshot_request());
  EXPECT_FALSE(viewer_->take_screenshot_request()) << "once";
  viewer_->act(Action::kScreenshot);
  EXPECT_TRUE(viewer_->take_screenshot_request());
}

TEST_F(ViewerTest, ShowsASurfaceInItsOwnColour) {
  Scene scene;
  scene.albedo.keys = {{-0.4f, Vec3f(0.2f)}, {-0.3f, Vec3f(0.9f)}};
  look([&](ViewerSettings& s) { s.scene = scene; });
  const Colour before = middle();
  viewer_->act(Action::kIsovalueFarUp);
  EXPECT_EQ(middle(), before) << "as long as it is shown";
  rest();
  EXPECT_NE(middle(), before);
}

TEST_F(ViewerTest, DrawsPicturesLargerThanItsFramebuffer) {
  look([](ViewerSettings& s) { s.layout = Layout::kSideBySide; }, dim_light({}));
  constexpr int kWidth = 2 * kSize;
  const Image image = draw_picture(kWidth, kSize, [&](const glm::ivec2& first) {
    viewer_->draw_surface({kWidth, kSize, 1.0}, first);
  });
  EXPECT_NEAR(srgb_code(image.at(kSize / 2, kSize / 2).x), srgb_code(0.8f * 0.85f), 2)
      << "the headlight and half the sky";
  EXPECT_NEAR(srgb_code(image.at(kSize * 3 / 2, kSize / 2).x), srgb_code(0.8f * 0.25f), 1) << "the light";
}

TEST_F(ViewerTest, WritesItsHintOverNoName) {
  look([](ViewerSettings& s) { s.layout = Layout::kSideBySide; }, dim_light({}));
  const auto names_of = [&](int width) {
    const Image image = draw_picture(width, kSize, [&](const glm::ivec2&) { viewer_->draw({width, kSize, 1.0}); });
    std::vector<float> row;
    for (int y = 0; y < 40; ++y)
      for (int x = width / 2 + 5; x < width / 2 + 130; ++x) row.push_back(image.at(x, y).x);
    return row;
  };
  EXPECT_EQ(names_of(280), names_of(1200)) << "of the right pane";
}

TEST_F(ViewerTest, ExposesGlobalLightAndNotItsGroundAsTheRaycasterDoes) {
  look([&](ViewerSettings& s) { s.exposure_stops = -1.0; }, dim_light({}));
  expect_shown(corner(), Vec3f(0.2f));
  act(Action::kToggleLight);
  expect_shown(corner(), Vec3f(0.2f));
  const Colour local = middle();
  act(Action::kBrighter);
  EXPECT_EQ(middle(), local);
  EXPECT_THAT(texts(), Contains(HasSubstr("-0.67 stops")));
}

}  // namespace
}  // namespace isolux::viewer
