#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <mutex>

namespace isolux {

void throw_if_stopped(const Run& run) {
  if (run.stop.stop_requested()) throw Cancelled("interrupted");
}

std::size_t block_count(std::size_t count, std::size_t block_size) { return (count + block_size - 1) / block_size; }

int thread_count(const Run& run) {
  // More threads than cores would need a tbb::global_control, and ending one can wait forever in oneTBB 2021.8 (Debian
  // 12), for workers that have gone to sleep.
  const int cores = tbb::info::default_concurrency();
  return run.threads > 0 ? std::min(run.threads, cores) : cores;
}

void parallel_blocks(std::size_t count, std::size_t block_size, const Run& run, std::string_view stage,
                     const std::function<void(const Block&)>& body) {
  const std::size_t blocks = block_count(count, block_size);
  std::atomic<std::size_t> done{0};
  std::mutex reporting;
  const auto work = [&](std::size_t b) {
    throw_if_stopped(run);
    body({.begin = b * block_size, .end = std::min(count, (b + 1) * block_size), .index = b});
    const std::size_t now = ++done;
    if (!run.progress || stage.empty()) return;
    // A thread that finds another one reporting lets it: progress is for people.
    const std::unique_lock lock(reporting, std::try_to_lock);
    if (lock.owns_lock()) run.progress(stage, double(now) / double(blocks));
  };
  const int threads = thread_count(run);
  if (threads == 1) {
    for (std::size_t b = 0; b < blocks; ++b) work(b);
  } else {
    tbb::task_arena arena(threads);
    arena.execute([&] { tbb::parallel_for(std::size_t(0), blocks, work, tbb::simple_partitioner()); });
  }
  throw_if_stopped(run);
}

}  // namespace isolux
