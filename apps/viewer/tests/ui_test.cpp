#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "ui/keys.h"
#include "ui/panes.h"
#include "ui/slider.h"
#include "ui/text.h"

namespace isolux::viewer {
namespace {

Slider make_slider() {
  Slider slider(-1.0, 3.0, 0.0);
  slider.place({100.0, 500.0, 400.0, 20.0});
  return slider;
}

TEST(Slider, MapsValuesToPixelsAndBack) {
  Slider slider = make_slider();
  EXPECT_DOUBLE_EQ(slider.position(), 200.0);
  for (const double value : {-1.0, -0.3, 1.7, 3.0}) {
    slider.set_value(value);
    EXPECT_NEAR(slider.value_at(slider.position()), value, 1e-12) << "rounding of doubles";
  }
}

TEST(Slider, StaysWithinItsRange) {
  Slider slider = make_slider();
  slider.set_value(7.0);
  EXPECT_EQ(slider.value(), 3.0);
  slider.step(-2.0);
  EXPECT_EQ(slider.value(), -1.0);
  slider.step(0.25);
  EXPECT_EQ(slider.value(), 0.0);
  EXPECT_EQ(slider.value_at(-1000.0), -1.0);
  EXPECT_EQ(slider.value_at(1e6), 3.0);
}

TEST(Slider, JumpsToTheMouseOnTheTrack) {
  Slider slider = make_slider();
  EXPECT_TRUE(slider.press(400.0, 510.0));
  EXPECT_DOUBLE_EQ(slider.value(), 2.0);
  slider.drag(300.0);
  EXPECT_DOUBLE_EQ(slider.value(), 1.0);
  slider.drag(-50.0);
  EXPECT_EQ(slider.value(), -1.0);
}

TEST(Slider, IsHeldAsItWasTaken) {
  Slider slider = make_slider();
  EXPECT_TRUE(slider.press(203.0, 510.0));
  EXPECT_EQ(slider.value(), 0.0) << "taking the knob off its middle does not move it";
  slider.drag(303.0);
  EXPECT_DOUBLE_EQ(slider.value(), 1.0);
}

TEST(Slider, LeavesTheMouseToOthersElsewhere) {
  Slider slider = make_slider();
  EXPECT_FALSE(slider.press(300.0, 499.0));
  EXPECT_FALSE(slider.press(300.0, 521.0));
  EXPECT_FALSE(slider.press(90.0, 510.0));
  slider.drag(450.0);
  EXPECT_EQ(slider.value(), 0.0);
  EXPECT_TRUE(slider.press(97.0, 510.0)) << "half a knob stands over the track's end";
  slider.release();
  slider.drag(450.0);
  EXPECT_EQ(slider.value(), -1.0);
}

TEST(Slider, HasAPlaceForARangeOfOneValue) {
  Slider slider(5.0, 5.0, 5.0);
  slider.place({0.0, 0.0, 100.0, 10.0});
  EXPECT_EQ(slider.position(), 50.0);
  EXPECT_TRUE(slider.press(90.0, 5.0));
  EXPECT_EQ(slider.value(), 5.0);
}

TEST(Slider, TellsNeighbouringStepsApart) {
  const std::array<std::pair<double, double>, 6> ranges{
      {{0.0, 1.0}, {0.0, 255.0}, {-1024.0, 3071.0}, {1000.0, 1001.0}, {-1e-7, 1e-7}, {65535.0, 65536.0}}};
  for (const auto& [low, high] : ranges) {
    Slider slider(low, high, 0.5 * (low + high));
    for (int i = 0; i < 50; ++i) {
      const std::string before = slider.text();
      slider.step(1.0 / 500.0);
      EXPECT_NE(slider.text(), before) << low << " to " << high;
    }
  }
  EXPECT_EQ(Slider(0.0, 255.0, 128.62501).text(), "128.63") << "no more digits than that takes";
}

TEST(Panes, CoverTheWindowWithoutGapOrOverlap) {
  for (const int width : {1, 2, 801, 1200}) {
    const auto panes = make_panes(Layout::kSideBySide, width, 600);
    ASSERT_EQ(panes.size(), 2u);
    EXPECT_EQ(panes[0].lighting, Lighting::kLocal);
    EXPECT_EQ(panes[1].lighting, Lighting::kGlobal);
    EXPECT_EQ(panes[0].box.x + panes[0].box.width, panes[1].box.x);
    EXPECT_EQ(panes[1].box.x + panes[1].box.width, width);
  }
  EXPECT_EQ(make_panes(Layout::kGlobal, 800, 600).size(), 1u);
}

TEST(Panes, TellWhichOneTheMouseIsIn) {
  const auto panes = make_panes(Layout::kSideBySide, 800, 600);
  EXPECT_EQ(pane_at(panes, 399.0), 0u);
  EXPECT_EQ(pane_at(panes, 400.0), 1u);
  EXPECT_EQ(pane_at(panes, -10.0), 0u);
  EXPECT_EQ(pane_at(panes, 9000.0), 1u);
}

TEST(Panes, MeasurePlacesFromTheMiddleUpwardsByTheShorterSide) {
  const Box wide{400.0, 0.0, 400.0, 200.0};
  EXPECT_EQ(picture_place(wide, 600.0, 100.0), glm::dvec2(0.0, 0.0));
  EXPECT_EQ(picture_place(wide, 800.0, 0.0), glm::dvec2(2.0, 1.0));
  const Box tall{0.0, 0.0, 200.0, 400.0};
  EXPECT_EQ(picture_place(tall, 0.0, 400.0), glm::dvec2(-1.0, -2.0));
}

TEST(Panes, KeepTheSliderInTheWindow) {
  const Box track = slider_track(800.0, 600.0, 2.0);
  EXPECT_GE(track.x, 0.0);
  EXPECT_LE(track.x + track.width, 800.0);
  EXPECT_LE(track.y + track.height, 600.0);
}

TEST(Text, DrawsEveryPrintableCharacterButTheSpaceWithinItsWidth) {
  for (char c = '!'; c <= '~'; ++c) {
    const std::string text(1, c);
    const auto boxes = text_boxes(text);
    EXPECT_FALSE(boxes.empty()) << c;
    for (const Box& box : boxes) {
      EXPECT_GE(box.x, 0.0) << c;
      EXPECT_LE(box.x + box.width, text_width(text)) << c;
      EXPECT_GE(box.y, 0.0) << c;
    }
  }
  EXPECT_TRUE(text_boxes(" ").empty());
}

TEST(Text, ShowsWhatTheFontLacksAsQuestionMarks) {
  EXPECT_EQ(text_boxes("\t\x7f\xff\xc3").size(), 4 * text_boxes("?").size());
  EXPECT_EQ(text_width("\xe8\x80\xb3\xf0\x9f\x91\x82"), text_width("??")) << "one a character";
}

TEST(Text, TakesTheAccentsOffLetters) {
  EXPECT_EQ(wrap_text("Geh\xc3\xb6r \xc3\x89tude \xc5\xbb\xc5\x82oty a\xcc\x88", 1e9), "Gehor Etude Zloty a");
  EXPECT_EQ(text_width("\xc3\xa9"), text_width("e"));
}

TEST(Text, WrapsBetweenWordsAndWithinThoseTooLong) {
  EXPECT_EQ(wrap_text("a b", 1e9), "a b");
  EXPECT_EQ(wrap_text("one two three", text_width("one two")), "one two\nthree");
  EXPECT_EQ(wrap_text("one\ntwo", text_width("one two")), "one\ntwo");
  EXPECT_EQ(wrap_text("abcabc", text_width("abc")), "abc\nabc");
  EXPECT_EQ(wrap_text("ab", 0.0), "a\nb") << "never without end";
  const std::string words = "the light is of isovalues 100 to 200, /a/path/that/is/longer/than/a/line/of/text.nrrd";
  for (double most = 20.0; most < 400.0; most += 7.0) EXPECT_LE(text_width(wrap_text(words, most)), most);
}

TEST(Text, TakesTheLongestLineForItsWidth) { EXPECT_EQ(text_width("ab\nabcdef\nabc"), text_width("abcdef")); }

TEST(Keys, MeanOneActionEach) {
  std::set<std::pair<int, bool>> seen;
  for (const KeyBinding& binding : key_bindings()) {
    EXPECT_TRUE(seen.insert({binding.key, binding.shift}).second) << binding.key;
    EXPECT_EQ(action_of(binding.key, binding.shift ? GLFW_MOD_SHIFT : 0), binding.action);
  }
}

TEST(Keys, KnowThreeMouseButtons) {
  EXPECT_EQ(button_of(GLFW_MOUSE_BUTTON_LEFT, 0), MouseButton::kLeft);
  EXPECT_EQ(button_of(GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_SHIFT), MouseButton::kMiddle);
  EXPECT_EQ(button_of(GLFW_MOUSE_BUTTON_MIDDLE, 0), MouseButton::kMiddle);
  EXPECT_EQ(button_of(GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOD_SHIFT), MouseButton::kRight);
  EXPECT_EQ(button_of(GLFW_MOUSE_BUTTON_4, 0), std::nullopt);
  EXPECT_EQ(button_of(GLFW_MOUSE_BUTTON_5, 0), std::nullopt);
}

TEST(Keys, LeaveCombinationsToTheSystem) {
  EXPECT_EQ(action_of(GLFW_KEY_Q, GLFW_MOD_CONTROL), std::nullopt);
  EXPECT_EQ(action_of(GLFW_KEY_Q, GLFW_MOD_CAPS_LOCK), Action::kQuit);
  EXPECT_EQ(action_of(GLFW_KEY_Z, 0), std::nullopt);
}

}  // namespace
}  // namespace isolux::viewer
