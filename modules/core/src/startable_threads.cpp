#include "startable_threads.h"

#include <dirent.h>
#include <isolux/core/machine_memory.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <latch>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace isolux::detail {
namespace {

// Not by std::filesystem, which ends the program where memory has ended.
std::size_t threads_now() {
  const auto close = [](DIR* folder) { closedir(folder); };
  const std::unique_ptr<DIR, decltype(close)> tasks(opendir("/proc/self/task"), close);
  std::size_t count = 0;
  while (tasks && readdir(tasks.get()) != nullptr) ++count;
  return count;
}

/// Addresses that a thread takes: 4 MB of stack by oneTBB's choice and, with the first that it allocates, 128 MB of
/// which half are given back.
constexpr double kAddressesAThread = 144e6;

/// Starts as many as there are addresses for and ends them again. Where the system refuses some, the half of the
/// others: whoever shares the limit wants some, too.
int try_threads(int wanted) {
  wanted = 1 + int(std::min(double(wanted - 1), free_addresses() / kAddressesAThread));
  const std::size_t before = threads_now();
  int started = 1;
  std::latch end(1);
  {
    std::vector<std::jthread> threads;
    threads.reserve(std::size_t(wanted));
    try {
      for (; started < wanted; ++started) threads.emplace_back([&end] { end.wait(); });
    } catch (const std::exception&) {  // neither a thread nor the memory for one is left
    }
    end.count_down();
  }
  // The system counts a thread for a moment after its end.
  const auto latest = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
  while (threads_now() > before && std::chrono::steady_clock::now() < latest)
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  return started < wanted ? std::max(1, started / 2) : wanted;
}

/// What has been tried out so far.
struct Known {
  std::mutex guard;
  int most = 1;
  std::optional<tbb::global_control> limit;  ///< `most` is all there are
};

}  // namespace

int startable_threads(int wanted) {
  static auto& known = *new Known;  // never destroyed: loops may run while static objects go
  const std::lock_guard lock(known.guard);
  if (wanted <= known.most) return wanted;
  if (!known.limit) {
    known.most = try_threads(wanted);
    // oneTBB starts its threads from one another, where a refusal ends the program.
    if (known.most < wanted) known.limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(known.most));
  }
  return known.most;
}

}  // namespace isolux::detail
