#include <gtest/gtest.h>
#include <isolux/core/quantile.h>

#include <cstddef>
#include <limits>
#include <vector>

namespace isolux {
namespace {

TEST(Quantile, IsTheValueThatAPartDoesNotExceed) {
  const std::vector<float> values{3.0f, 1.0f, 5.0f, 2.0f, 4.0f};
  EXPECT_EQ(quantile(values, 0.0), 1.0f);
  EXPECT_EQ(quantile(values, 0.5), 3.0f);
  EXPECT_EQ(quantile(values, 1.0), 5.0f);
  EXPECT_EQ(quantile({}, 0.5), 0.0f);
}

TEST(Quantile, IsNotMovedByASpike) {
  std::vector<float> values(100, 2.0f);
  values[40] = std::numeric_limits<float>::max();
  EXPECT_EQ(quantile(values, 0.9), 2.0f);
}

// Where steps of a part's size would meet a single column of a grid. One drawn of 64 of each share is off the middle by
// .5 / sqrt(65536) = .002 at one standard deviation.
TEST(Quantile, OfManyValuesIsOfAllColumns) {
  std::vector<float> values(std::size_t(1) << 22);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i % 64) / 63.0f;
  EXPECT_NEAR(quantile(values, 0.5), 0.5, 0.02);
}

}  // namespace
}  // namespace isolux
