#include <gtest/gtest.h>
#include <isolux/core/machine_memory.h>
#include <isolux/core/release.h>

namespace isolux {
namespace {

TEST(Release, GivesTheMemoryBack) {
  std::vector<float> array(1000, 1.0f);
  release(array);
  EXPECT_TRUE(array.empty());
  EXPECT_EQ(array.capacity(), 0u);
}

TEST(PeakMemory, CountsWhatIsWrittenTo) {
  constexpr std::size_t kBytes = std::size_t(64) << 20;
  const std::uint64_t before = peak_memory();
  EXPECT_GT(before, 0u);
  {
    const std::vector<char> array(kBytes, 1);
    EXPECT_GE(peak_memory(), kBytes);
  }
  return_freed_memory();
  EXPECT_GE(peak_memory(), kBytes);  // what has been freed, too
}

}  // namespace
}  // namespace isolux
