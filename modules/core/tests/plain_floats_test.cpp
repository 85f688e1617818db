#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/plain_floats.h>
#include <isolux/core/volume.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "hosts_floats.h"

namespace isolux {
namespace {

TEST(PlainFloats, AreThoseOfEveryBodyOfALoop) {
  for (const int threads : {1, 3}) {
    const test::HostsFloats hosts;
    const int traps = fegetexcept();
    std::atomic<int> rounded{0};
    std::atomic<int> infinite{0};
    parallel_blocks(100, 1, {.threads = threads}, "", [&](const Block& block) {
      rounded += std::fegetround() == FE_TONEAREST ? 1 : 0;
      volatile double zero = 0.0 * double(block.index);
      infinite += std::isinf(1.0 / zero) ? 1 : 0;
    });
    EXPECT_EQ(rounded, 100);
    EXPECT_EQ(infinite, 100);
    EXPECT_EQ(std::fegetround(), FE_UPWARD);
    EXPECT_EQ(fegetexcept(), traps);
    EXPECT_EQ(std::fetestexcept(FE_DIVBYZERO), 0);
  }
}

TEST(PlainFloats, GoWithTheirScopeWhateverIsThrown) {
  const test::HostsFloats hosts;
  EXPECT_THROW(parallel_blocks(1, 1, {.threads = 1}, "", [](const Block&) { throw InvalidInput("no"); }), InvalidInput);
  EXPECT_EQ(std::fegetround(), FE_UPWARD);
}

TEST(PlainFloats, LetVolumesBeLookedAtForWhatIsNoNumber) {
  Volume volume;
  volume.values = Grid<float>(Lattice{.size = Index3(8), .frame = {}}, 1.0f);
  volume.values(3, 4, 5) = std::numeric_limits<float>::signaling_NaN();
  const test::HostsFloats hosts;
  EXPECT_THROW(require_usable(volume), InvalidInput);
}

}  // namespace
}  // namespace isolux
