#include "plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace isolux::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

Plot two_curves() {
  return {.id = "p",
          .title = "a < b & c",
          .x_label = "x",
          .y_label = "y",
          .series = {{"first", {{1, 10, 8, 12}, {100, 0.1}}}, {"second", {{10, 1}}}, {"nothing", {}}}};
}

TEST(Svg, EscapesTextAndListsSeriesWithPoints) {
  const std::string text = svg(two_curves());
  EXPECT_THAT(text, HasSubstr("a &lt; b &amp; c"));
  EXPECT_THAT(text, HasSubstr(">first<"));
  EXPECT_THAT(text, HasSubstr(">second<"));
  EXPECT_THAT(text, Not(HasSubstr("nothing")));
}

TEST(Svg, NeverHoldsANumberThatIsNone) {
  Plot plot = two_curves();
  plot.series[0].points.push_back({-1.0, 5.0});
  plot.series[0].points.push_back({2.0, std::numeric_limits<double>::infinity()});
  plot.series[0].points.push_back({3.0, kNone});
  for (const Plot& p : {plot, Plot{.id = "e", .title = "empty", .x_label = "", .y_label = ""}}) {
    const std::string text = svg(p);
    EXPECT_THAT(text, Not(HasSubstr("nan")));
    EXPECT_THAT(text, Not(HasSubstr("inf")));
  }
}

TEST(Svg, LogarithmicTicksAreDecadesOverManyDecades) {
  Plot plot = two_curves();
  plot.series[1].points = {{1e6, 1}};
  const std::string text = svg(plot);
  EXPECT_THAT(text, HasSubstr(">1e+06<"));
  EXPECT_THAT(text, Not(HasSubstr(">2e+05<")));
}

TEST(NumberText, IsShortAndEmptyForNone) {
  EXPECT_EQ(number_text(3.0), "3");
  EXPECT_EQ(number_text(0.123456), "0.1235");
  EXPECT_EQ(number_text(kNone), "");
}

}  // namespace
}  // namespace isolux::bench
