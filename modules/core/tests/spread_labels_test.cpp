#include <gtest/gtest.h>
#include <isolux/core/spread_labels.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <vector>

namespace isolux::test {
namespace {

TEST(SpreadLabels, GivesEveryPlaceTheLabelOfANearestOne) {
  const Index3 size{7, 5, 6};
  const std::vector<Index3> labelled{{0, 0, 0}, {6, 1, 2}, {3, 4, 5}};
  const auto offset = [&](const Index3& i) { return std::size_t((i.z * size.y + i.y) * size.x + i.x); };
  const auto steps = [](const Index3& a, const Index3& b) {
    return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
  };
  std::vector<std::uint32_t> labels(7 * 5 * 6, kNoLabel);
  for (std::uint32_t l = 0; l < labelled.size(); ++l) labels[offset(labelled[l])] = l;
  spread_labels(size, labels);
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        int nearest = std::numeric_limits<int>::max();
        for (const Index3& at : labelled) nearest = std::min(nearest, steps(at, {i, j, k}));
        const std::uint32_t label = labels[offset({i, j, k})];
        ASSERT_LT(label, labelled.size());
        EXPECT_EQ(steps(labelled[label], {i, j, k}), nearest);
      }
    }
  }
}

TEST(SpreadLabels, LeavesAGridWithoutLabelsAlone) {
  std::vector<std::uint32_t> labels(8, kNoLabel);
  spread_labels({2, 2, 2}, labels);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), kNoLabel), 8);
}

}  // namespace
}  // namespace isolux::test
