#include "stats.h"

#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <cmath>
#include <numeric>

namespace isolux::bench {
namespace {

TEST(PowerLaw, HasNoBarForTwoPoints) {
  const std::vector<double> x{1.0, 2.0};
  const std::vector<double> y{4.0, 1.0};
  const PowerLaw law = fit_power_law(x, y);
  EXPECT_DOUBLE_EQ(law.exponent, -2.0);
  EXPECT_EQ(bar_text(law), "");
}

TEST(Quantile, IsLinearBetweenOrderStatistics) {
  const std::vector<double> values{4, 1, 3, 2};
  EXPECT_DOUBLE_EQ(quantile(values, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0), 4.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(median(values).low, 1.75);
}

TEST(PowerLaw, RecoversAnExactLaw) {
  const std::vector<double> x{1, 2, 4, 10};
  std::vector<double> y;
  for (const double v : x) y.push_back(3.0 * std::pow(v, -0.75));
  const PowerLaw law = fit_power_law(x, y);
  // Rounding of a dozen logarithms.
  EXPECT_NEAR(law.exponent, -0.75, 1e-12);
  EXPECT_NEAR(law.factor, 3.0, 1e-12);
  EXPECT_NEAR(law.exponent_error, 0.0, 1e-7);
}

TEST(PowerLaw, ErrorBarCoversTheExponentOfNoisyData) {
  std::vector<double> x;
  std::vector<double> y;
  RandomStream random(3, 0);
  for (int i = 1; i <= 40; ++i) {
    x.push_back(i);
    y.push_back(std::pow(double(i), -0.5) * std::exp(0.2 * (random.uniform_double() - 0.5)));
  }
  const PowerLaw law = fit_power_law(x, y);
  EXPECT_GT(law.exponent_error, 0.0);
  EXPECT_LT(std::fabs(law.exponent + 0.5), 4.0 * law.exponent_error);  // four deviations of a fixed seed
}

TEST(Bootstrap, IntervalHoldsTheRmsAndShrinksWithMoreValues) {
  std::vector<double> few;
  std::vector<double> many;
  RandomStream random(5, 0);
  for (int i = 0; i < 10000; ++i) {
    many.push_back(random.uniform_double() - 0.5);
    if (i < 100) few.push_back(many.back());
  }
  const Estimate narrow = rms_interval(many, 1);
  const Estimate wide = rms_interval(few, 1);
  EXPECT_LE(narrow.low, narrow.value);
  EXPECT_GE(narrow.high, narrow.value);
  EXPECT_NEAR(narrow.value, std::sqrt(1.0 / 12.0), 0.005);            // the standard deviation of a uniform number
  EXPECT_GT(wide.high - wide.low, 5.0 * (narrow.high - narrow.low));  // 10 times wider in the mean
}

TEST(Timed, CallsAtLeastOnceAndAtMostAsOftenAsAsked) {
  int calls = 0;
  EXPECT_GE(timed([&] { ++calls; }, 3, 100.0).value, 0.0);
  EXPECT_EQ(calls, 3);
  (void)timed([&] { ++calls; }, 3, 0.0);
  EXPECT_EQ(calls, 4);
}

}  // namespace
}  // namespace isolux::bench
