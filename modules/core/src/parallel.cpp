#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/plain_floats.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "startable_threads.h"

namespace isolux {
namespace {

/// An arena of oneTBB for one loop, from a store of those that no loop uses: oneTBB 2021.8 keeps something of every
/// arena that is made, so that a process that made one a loop would be slower with each.
class Arena {
 public:
  explicit Arena(int threads) : threads_(threads) {
    const std::scoped_lock lock(store().guard);
    auto& [unused, made] = store().by_threads[threads];
    if (unused.empty()) {
      unused.reserve(made + 1);  // so that it can come back without memory
      arena_ = std::make_unique<tbb::task_arena>(threads);
      ++made;
    } else {
      arena_ = std::move(unused.back());
      unused.pop_back();
    }
  }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;
  ~Arena() {
    const std::scoped_lock lock(store().guard);
    store().by_threads.find(threads_)->second.unused.push_back(std::move(arena_));
  }

  [[nodiscard]] tbb::task_arena& get() { return *arena_; }

 private:
  struct Alike {
    std::vector<std::unique_ptr<tbb::task_arena>> unused;
    std::size_t made = 0;
  };
  struct Store {
    std::mutex guard;
    std::map<int, Alike> by_threads;
  };
  /// Never destroyed: loops may run while static objects go.
  static Store& store() {
    static auto* const one = new Store;
    return *one;
  }

  int threads_;
  std::unique_ptr<tbb::task_arena> arena_;
};

/// What the program around this allows oneTBB, which prints a warning where more are asked for.
int threads_of_host() {
  const std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return allowed < std::size_t(tbb::info::default_concurrency()) ? int(allowed) : std::numeric_limits<int>::max();
}

}  // namespace

void throw_if_stopped(const Run& run) {
  if (run.stop.stop_requested()) throw Cancelled("interrupted");
}

Run part_of(const Run& run, double begin, double end) {
  Run part = run;
  if (run.progress) {
    part.progress = [&run, begin, end](std::string_view stage, double fraction) {
      run.progress(stage, begin + fraction * (end - begin));
    };
  }
  return part;
}

std::size_t block_count(std::size_t count, std::size_t block_size) {
  if (block_size == 0) throw InvalidInput("blocks of 0 items: allowed is 1 and more");
  return count / block_size + (count % block_size != 0 ? 1 : 0);  // without sums, which may be beyond a size_t
}

int thread_count(const Run& run) { return run.threads > 0 ? run.threads : tbb::info::default_concurrency(); }

void parallel_blocks(std::size_t count, std::size_t block_size, const Run& run, std::string_view stage,
                     const std::function<void(const Block&)>& body) {
  const std::size_t blocks = block_count(count, block_size);
  std::atomic<std::size_t> done{0};
  std::mutex reporting;
  const auto work = [&](std::size_t b) {
    throw_if_stopped(run);
    const std::size_t begin = b * block_size;
    {
      const PlainFloats plain;
      body({.begin = begin, .end = begin + std::min(block_size, count - begin), .index = b});
    }
    const std::size_t now = ++done;
    if (!run.progress || stage.empty()) return;
    // A thread that finds another one reporting lets it: progress is for people.
    const std::unique_lock lock(reporting, std::try_to_lock);
    if (lock.owns_lock()) run.progress(stage, double(now) / double(blocks));
  };
  // More threads than blocks would only be started and ended, for every loop again.
  const int wanted = int(std::min(std::size_t(thread_count(run)), blocks));
  const int threads = detail::startable_threads(std::min(wanted, threads_of_host()));
  if (threads <= 1) {
    for (std::size_t b = 0; b < blocks; ++b) work(b);
  } else {
    // oneTBB prints a warning when it is asked for more threads than this process may run at once, unless told so
    // before.
    std::optional<tbb::global_control> more_than_cores;
    if (threads > tbb::info::default_concurrency()) {
      more_than_cores.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    }
    Arena arena(threads);
    arena.get().execute([&] { tbb::parallel_for(std::size_t(0), blocks, work, tbb::simple_partitioner()); });
  }
  throw_if_stopped(run);
}

}  // namespace isolux
