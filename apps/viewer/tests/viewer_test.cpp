// What the viewer does and says.
#include "app/viewer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "viewer_fixture.h"

namespace isolux::viewer {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

TEST_F(ViewerTest, ShowsExactLightInTheColoursOfTheScene) {
  Scene scene;
  scene.albedo.keys = {{0.0f, {0.9f, 0.05f, 0.05f}}};
  scene.emission.keys = {{0.0f, {0.0f, 0.02f, 0.0f}}};
  look([&](ViewerSettings& s) {
    s.exact_light = true;
    s.scene = scene;
  });
  // Emission lights a ball no further, for nothing of it sees itself.
  expect_shown(middle(), {0.9f, 0.07f, 0.05f});
  EXPECT_EQ(left_name(), "global light, exact");
}

// From outside a ball whose higher side is the outer one shows its inner side, which has no light of its own.
TEST_F(ViewerTest, HasOneOuterSideForMeshAndExactLightAndDrafts) {
  Scene higher;
  higher.outer = OuterSide::kHigher;
  Scene both;
  both.sides = LitSides::kBoth;
  const Vec3f dim(0.8f * 0.1f * 0.85f);
  look([&](ViewerSettings& s) {
    s.exact_light = true;
    s.scene = higher;
  });
  expect_shown(middle(), dim);
  look([&](ViewerSettings& s) {
    s.outer = OuterSide::kHigher;
    s.scene = Scene{};
  });
  act(Action::kBake);
  EXPECT_EQ(left_name(), "global light");
  expect_shown(middle(), dim);
  look([&](ViewerSettings& s) {
    s.outer = OuterSide::kHigher;
    s.scene = both;
  });
  act(Action::kBake);
  act(Action::kExactLight);
  expect_shown(middle(), Vec3f(0.8f));
}

TEST_F(ViewerTest, BakesADraftInTheSceneOfTheLightAndGivesThatBack) {
  look([](ViewerSettings&) {}, dim_light({}));
  const Colour before = middle();
  act(Action::kBake);
  expect_shown(middle(), Vec3f(0.8f * 0.25f));
  EXPECT_THAT(texts(), Contains(HasSubstr("instead of the light given; b brings that back")));
  act(Action::kBake);
  EXPECT_THAT(texts(), Contains("the light given again"));
  EXPECT_EQ(middle(), before);
  Scene white;
  look([&](ViewerSettings& s) { s.scene = white; }, dim_light({}));
  act(Action::kBake);
  expect_shown(middle(), Vec3f(0.8f));
}

TEST_F(ViewerTest, BakesADraftOfAVolumeLongerThanTheLargestTexture) {
  const int length = largest_texture() + 2;
  const auto folder = std::filesystem::temp_directory_path();
  const auto path = folder / ("isolux-long_" + std::to_string(length) + "x3x3_uint8.raw");
  {
    std::vector<char> values(std::size_t(length) * 9);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = char((i * 37) % 101);
    std::ofstream(path, std::ios::binary).write(values.data(), std::streamsize(values.size()));
  }
  look([](ViewerSettings&) {}, nullptr, path.string());
  std::filesystem::remove(path);
  act(Action::kBake);
  EXPECT_THAT(texts(), Contains(HasSubstr("a draft of the light")));
  EXPECT_EQ(left_name(), "global light");
}

TEST_F(ViewerTest, CallsLightLocalUntilThereIsAnother) {
  look([&](ViewerSettings& s) { s.layout = Layout::kGlobal; });
  EXPECT_EQ(left_name(), "local light");
  viewer_->act(Action::kExactLight);
  viewer_->act(Action::kToggleLight);
  EXPECT_THAT(texts(), Contains(HasSubstr("exact light is being traced")));
  EXPECT_THAT(texts(), Each(Not(HasSubstr("press b"))));
  rest();
  EXPECT_EQ(left_name(), "global light, exact");
}

TEST_F(ViewerTest, RefusesALightOfTheOtherSideAlone) {
  EXPECT_THROW(look([](ViewerSettings& s) { s.outer = OuterSide::kHigher; }, dim_light({})), InvalidInput);
}

TEST_F(ViewerTest, ShowsLocalLightUntilGlobalLightIsAskedFor) {
  look([](ViewerSettings& s) {
    s.layout = Layout::kLocal;
    s.exact_light = true;
  });
  EXPECT_EQ(viewer_->layout(), Layout::kLocal);
  act(Action::kToggleLight);
  EXPECT_EQ(viewer_->layout(), Layout::kGlobal);
  act(Action::kToggleLight);
  act(Action::kIsovalueUp);
  EXPECT_EQ(viewer_->layout(), Layout::kLocal) << "also where light was traced again";
  act(Action::kBake);
  EXPECT_EQ(viewer_->layout(), Layout::kGlobal);
  look([](ViewerSettings&) {});
  act(Action::kExactLight);
  EXPECT_EQ(viewer_->layout(), Layout::kGlobal);
}

TEST_F(ViewerTest, TakesMessagesAwayAtTheNextInputOrAfterSomeTime) {
  look([&](ViewerSettings& s) { s.message_seconds = 600.0; });
  const auto said = [&] {
    const std::vector<std::string> all = texts();
    return std::find(all.begin(), all.end(), "hello") != all.end();
  };
  viewer_->say("hello");
  EXPECT_TRUE(said());
  viewer_->press(MouseButton::kRight);
  EXPECT_FALSE(said());
  viewer_->say("hello");
  viewer_->scroll(1.0);
  EXPECT_FALSE(said());
  EXPECT_EQ(viewer_->message_seconds_left(), std::nullopt);
  viewer_->say("hello");
  ASSERT_TRUE(viewer_->message_seconds_left().has_value());
  EXPECT_LE(*viewer_->message_seconds_left(), 600.0);
  EXPECT_FALSE(viewer_->update());
  EXPECT_TRUE(said());
  look([&](ViewerSettings& s) { s.message_seconds = 0.01; });
  viewer_->say("hello");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_TRUE(viewer_->update()) << "the picture changes";
  EXPECT_FALSE(said());
}

TEST_F(ViewerTest, SaysWarningsBesidesMessagesAndWithoutLight) {
  look([&](ViewerSettings& s) { s.isovalue = -5.0; });
  viewer_->say("hello");
  EXPECT_THAT(texts(), Contains("hello"));
  EXPECT_THAT(texts(), Contains(HasSubstr("no surface")));
  look([&](ViewerSettings& s) { s.isovalue = -0.2; }, dim_light(ValueRange{-0.41f, -0.39f}));
  viewer_->say("hello");
  EXPECT_THAT(texts(), Contains(HasSubstr("the light is of isovalues -0.41 to -0.39")));
  EXPECT_THAT(texts(), Contains("hello"));
}

TEST_F(ViewerTest, SaysThatAnIsovalueIsOutsideTheValues) {
  look([&](ViewerSettings& s) { s.isovalue = 5.0; });
  EXPECT_THAT(texts(), Contains(HasSubstr("isovalue 5 is outside the values")));
  look([&](ViewerSettings& s) { s.isovalue = -0.3; });
  EXPECT_THAT(texts(), Each(Not(HasSubstr("outside"))));
}

TEST_F(ViewerTest, SavesNoColoursOfALightOfOtherIsovalues) {
  const auto before = std::filesystem::current_path();
  const auto folder = std::filesystem::temp_directory_path() / ("isolux-viewer-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::filesystem::current_path(folder);
  look([&](ViewerSettings& s) { s.isovalue = -0.2; }, dim_light(ValueRange{-0.41f, -0.39f}));
  act(Action::kExport);
  EXPECT_THAT(texts(), Contains(HasSubstr("without colours: the light is of other isovalues")));
  act(Action::kExactLight);
  act(Action::kExport);
  EXPECT_THAT(texts(), Contains("wrote gen_sphere_24--0.2-2.ply"));
  EXPECT_GT(std::filesystem::file_size("gen_sphere_24--0.2-2.ply"),
            std::filesystem::file_size("gen_sphere_24--0.2.ply"));
  std::filesystem::current_path(before);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace isolux::viewer
