#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "processor_time.h"

namespace isolux {
namespace {

TEST(ParallelBlocks, CoverEveryItemOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 5, 4096}) {
    std::vector<std::atomic<int>> seen(1003);
    parallel_blocks(seen.size(), 10, {.threads = threads}, "", [&](const Block& block) {
      EXPECT_EQ(block.begin, block.index * 10);
      for (std::size_t i = block.begin; i < block.end; ++i) ++seen[i];
    });
    for (const auto& count : seen) EXPECT_EQ(count, 1);
  }
}

TEST(ParallelBlocks, HeedWhatTheProgramAllowsOneTbb) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  ::testing::internal::CaptureStderr();
  const auto caller = std::this_thread::get_id();
  int elsewhere = 0;
  parallel_blocks(100, 1, {.threads = 4}, "",
                  [&](const Block&) { elsewhere += std::this_thread::get_id() == caller ? 0 : 1; });
  EXPECT_EQ(elsewhere, 0);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ParallelBlocks, MayBeAsLargeAsANumberCanBe) {
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  for (const std::size_t size : {kMost, kMost - 3}) {
    std::size_t items = 0;
    parallel_blocks(5, size, isolux::Run{}, "", [&](const Block& block) { items += block.end - block.begin; });
    EXPECT_EQ(items, 5u);
    EXPECT_EQ(block_count(5, size), 1u);
  }
}

// A window sweeps isovalues for hours. oneTBB 2021.8 keeps something of every arena: with one a loop the last of these
// took thirty times as long as the first.
TEST(ParallelBlocks, AreAsFastAfterManyLoopsAsBefore) {
  const auto seconds_of_loops = [](int loops) {
    const test::ProcessorTime time;
    for (int i = 0; i < loops; ++i) parallel_blocks(8, 1, {.threads = 2}, "", [](const Block& /*block*/) {});
    return time.seconds();
  };
  (void)seconds_of_loops(10);
  const double first = seconds_of_loops(200);
  (void)seconds_of_loops(10'000);
  // Threads that wait for one that a busy machine has put aside are at work, too: the best of many tries counts.
  const double most = 5.0 * first + 0.005;
  double later = seconds_of_loops(200);
  for (int i = 0; i < 50 && later >= most; ++i) later = std::min(later, seconds_of_loops(200));
  EXPECT_LT(later, most) << first << " s before, " << later << " s after";
}

TEST(ParallelBlocks, StopsWhenAsked) {
  std::stop_source stop;
  std::atomic<int> blocks{0};
  const isolux::Run run{.threads = 2, .stop = stop.get_token()};
  EXPECT_THROW(parallel_blocks(1'000'000, 1, run, "",
                               [&](const Block&) {
                                 if (++blocks == 10) stop.request_stop();
                               }),
               Cancelled);
  EXPECT_LT(blocks, 1000);
}

TEST(ParallelBlocks, ReportsAPartsProgressAsThatOfTheWhole) {
  std::vector<double> seen;
  const isolux::Run run{.threads = 1, .progress = [&](std::string_view, double part) { seen.push_back(part); }};
  parallel_blocks(4, 1, part_of(run, 0.5, 1.0), "stage", [](const Block&) {});
  EXPECT_EQ(seen, (std::vector<double>{0.625, 0.75, 0.875, 1.0}));
}

TEST(ParallelBlocks, PassesOnWhatTheBodyThrows) {
  EXPECT_THROW(parallel_blocks(100, 1, {.threads = 3}, "", [](const Block&) { throw InvalidInput("no"); }),
               InvalidInput);
}

TEST(ParallelBlocks, ReportsProgressUpToTheEnd) {
  double last = 0.0;
  isolux::Run run{.threads = 1};
  run.progress = [&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "work");
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  parallel_blocks(95, 10, run, "work", [](const Block&) {});
  EXPECT_EQ(last, 1.0);
}

TEST(Philox, GivesThePublishedBits) {
  // Known answers of the Random123 distribution (Salmon et al. 2011).
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(ReverseBits, TurnsEachBitRound) {
  for (unsigned bit = 0; bit < 32; ++bit) EXPECT_EQ(reverse_bits(1u << bit), 0x80000000u >> bit);
  EXPECT_EQ(reverse_bits(0x12345678u), 0x1E6A2C48u);
}

TEST(RandomStream, IsUniformAndKeyed) {
  RandomStream a(7, 1);
  RandomStream b(7, 2);
  RandomStream again(7, 1);
  double sum = 0.0;
  double sum_of_squares = 0.0;
  double product = 0.0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double x = a.uniform_double();
    EXPECT_EQ(x, again.uniform_double());
    EXPECT_GE(x, 0.0);
    EXPECT_LT(x, 1.0);
    sum += x;
    sum_of_squares += x * x;
    product += (x - 0.5) * (b.uniform_double() - 0.5);
  }
  // Five standard deviations of each mean.
  EXPECT_NEAR(sum / kCount, 0.5, 5 * std::sqrt(1.0 / 12 / kCount));
  EXPECT_NEAR(sum_of_squares / kCount, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / kCount));
  EXPECT_NEAR(product / kCount, 0.0, 5.0 / 12 / std::sqrt(double(kCount)));
}

}  // namespace
}  // namespace isolux
