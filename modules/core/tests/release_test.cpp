#include <gtest/gtest.h>
#include <isolux/core/release.h>

namespace isolux {
namespace {

TEST(Release, GivesTheMemoryBack) {
  std::vector<float> array(1000, 1.0f);
  release(array);
  EXPECT_TRUE(array.empty());
  EXPECT_EQ(array.capacity(), 0u);
}

}  // namespace
}  // namespace isolux
