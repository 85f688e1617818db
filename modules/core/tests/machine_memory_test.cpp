#include <gtest/gtest.h>
#include <isolux/core/machine_memory.h>
#include <isolux/core/release.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../src/memory_group.h"

namespace isolux {
namespace {

namespace fs = std::filesystem;

/// A folder with files as Linux has them.
class FakeSystem : public ::testing::Test {
 protected:
  void SetUp() override { fs::remove_all(root_); }
  void TearDown() override { fs::remove_all(root_); }
  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  [[nodiscard]] GroupMemory memory() const { return group_memory(root_.string()); }

 private:
  fs::path root_ = fs::path(::testing::TempDir()) /
                   (std::string("isolux_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(FakeSystem, WithoutGroupsThereIsNoLimit) {
  EXPECT_TRUE(std::isinf(memory().most));
  EXPECT_TRUE(std::isinf(memory().left));
  write("proc/self/cgroup", "0::/\nnonsense\n");
  write("sys/fs/cgroup/memory.max", "max\n");
  EXPECT_TRUE(std::isinf(memory().most));
}

TEST_F(FakeSystem, GroupsOfTheSecondVersionLimitWhatIsBelow) {
  write("proc/self/cgroup", "0::/jobs/one\n");
  write("sys/fs/cgroup/jobs/memory.max", "8000\n");
  write("sys/fs/cgroup/jobs/memory.current", "7500\n");
  write("sys/fs/cgroup/jobs/memory.stat", "anon 7000\nfile 500\ninactive_file 300\n");
  write("sys/fs/cgroup/jobs/one/memory.max", "5000\n");
  write("sys/fs/cgroup/jobs/one/memory.current", "1000\n");
  EXPECT_EQ(memory().most, 5000.0);
  EXPECT_EQ(memory().left, 800.0);  // of all jobs together
}

TEST_F(FakeSystem, GroupsOfTheFirstVersionAreFoundByPurpose) {
  write("proc/self/cgroup", "9:name=systemd:/other\n4:cpu,memory:/docker/abc\n0::/\n");
  // Within a container its group is the highest.
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "4000\n");
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "3000\n");
  write("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 500\n");
  EXPECT_EQ(memory().most, 4000.0);
  EXPECT_EQ(memory().left, 1500.0);
}

TEST(MachineMemory, IsAtLeastWhatIsFree) {
  EXPECT_GT(free_memory(), 0.0);
  EXPECT_LE(free_memory(), machine_memory());
}

TEST(MachineMemory, IsFreeAsFarAsThisProcessMayHaveIt) {
  constexpr rlim_t kLeft = rlim_t(64) << 20;
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  rlimit now = before;
  now.rlim_cur = pages * rlim_t(getpagesize()) + kLeft;
  ASSERT_EQ(setrlimit(RLIMIT_AS, &now), 0);
  const double left = free_memory();
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_NEAR(left, double(kLeft), 0x1p20);
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
