#include "child_process.h"

#include "support.h"

#include <gmock/gmock.h>
#include <isolux/core/parallel.h>

#include <csignal>
#include <thread>

namespace isolux {
namespace {
using detail::ByteSource;
using detail::SendBytes;
using std::chrono::seconds;
using testing::HasSubstr;

void take_nothing(ByteSource& received) {
  std::byte one{};
  (void)received.read(std::span(&one, 1));
}

std::string error_in_child(const std::function<void(const SendBytes&)>& work, seconds limit = seconds(20)) {
  return test::error_of([&] { detail::run_in_child("file", limit, isolux::Run{}, work, take_nothing); });
}

TEST(ChildProcess, SendsWhatTheWorkMakes) {
  std::vector<std::uint32_t> sent(1000000);
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = std::uint32_t(i * 2654435761u);
  std::vector<std::uint32_t> got(sent.size());
  detail::run_in_child(
      "file", seconds(20), isolux::Run{}, [&](const SendBytes& send) { send(std::as_bytes(std::span(sent))); },
      [&](ByteSource& received) { EXPECT_EQ(received.read(std::as_writable_bytes(std::span(got))), 4 * got.size()); });
  EXPECT_EQ(got, sent);
}

TEST(ChildProcess, TurnsCrashesIntoErrors) {
  EXPECT_THAT(error_in_child([](const SendBytes&) { std::raise(SIGKILL); }),
              HasSubstr("file: the library that reads it crashed"));
  EXPECT_THAT(error_in_child([](const SendBytes&) { std::_Exit(3); }),
              HasSubstr("file: the library that reads it failed"));
}

TEST(ChildProcess, PassesExceptionsOn) {
  EXPECT_THROW(
      detail::run_in_child(
          "file", seconds(20), isolux::Run{}, [](const SendBytes&) { throw InvalidInput("a\nb"); }, take_nothing),
      InvalidInput);
  EXPECT_EQ(error_in_child([](const SendBytes&) { throw std::runtime_error("a\nb"); }), "a b");
  // What the child says explains the bytes that are missing here.
  const auto missing = [](ByteSource& received) {
    take_nothing(received);
    throw IoError("too short");
  };
  EXPECT_EQ(test::error_of([&] {
              detail::run_in_child(
                  "file", seconds(20), isolux::Run{}, [](const SendBytes&) { throw IoError("why"); }, missing);
            }),
            "why");
  EXPECT_EQ(test::error_of([&] {
              detail::run_in_child(
                  "file", seconds(20), isolux::Run{}, [](const SendBytes&) {}, missing);
            }),
            "too short");
}

TEST(ChildProcess, GivesUpAHangAndStopsWhenAsked) {
  const auto hang = [](const SendBytes&) {
    for (;;) std::this_thread::sleep_for(seconds(1));
  };
  const auto before = std::chrono::steady_clock::now();
  EXPECT_THAT(error_in_child(hang, seconds(1)), HasSubstr("took too long"));
  std::stop_source stop;
  stop.request_stop();
  isolux::Run run;
  run.stop = stop.get_token();
  EXPECT_THROW(detail::run_in_child("file", seconds(600), run, hang, take_nothing), Cancelled);
  // One second of limit and two for last words; far from the 600.
  EXPECT_LT(std::chrono::steady_clock::now() - before, seconds(60));
}

TEST(ChildProcess, WorksBesideOtherThreadsAndFromSeveralAtOnce) {
  // Worker threads that hold malloc's locks most of the time.
  isolux::Run run;
  run.threads = 4;
  std::atomic<int> good{0};
  parallel_blocks(24, 1, run, "", [&](const Block& block) {
    std::vector<std::string> churn;
    churn.reserve(1000);
    for (int i = 0; i < 1000; ++i) churn.emplace_back(std::size_t(i), 'x');
    const auto number = std::uint64_t(block.index);
    std::uint64_t got = 0;
    detail::run_in_child(
        "file", seconds(60), isolux::Run{},
        [&](const SendBytes& send) {
          const std::vector<std::uint64_t> copy(100, number);
          send(std::as_bytes(std::span(copy).first(1)));
        },
        [&](ByteSource& received) { (void)received.read(std::as_writable_bytes(std::span(&got, 1))); });
    if (got == number) ++good;
  });
  EXPECT_EQ(good, 24);
}

}  // namespace
}  // namespace isolux
