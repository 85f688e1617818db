#pragma once

#include <isolux/core/run.h>

#include <cstddef>
#include <functional>
#include <string_view>

namespace isolux {

/// One block of a parallel loop: items [begin, end), block number `index`.
struct Block {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t index = 0;
};

/// Calls body for every block of `block_size` items, at least 1 (the last may be shorter), on run.threads threads
/// (oneTBB), or on those that the system or a tbb::global_control allows, if these are fewer. The blocks do not depend
/// on the number of threads: a reduction that keeps one partial result a block and adds them in order is the same
/// everywhere. Bodies have PlainFloats. Reports progress under `stage` (no report if empty). \throw Cancelled; whatever
/// body throws first; InvalidInput for blocks of no items.
void parallel_blocks(std::size_t count, std::size_t block_size, const Run& run, std::string_view stage,
                     const std::function<void(const Block&)>& body);

/// Number of blocks that parallel_blocks makes.
[[nodiscard]] std::size_t block_count(std::size_t count, std::size_t block_size);

/// The threads a run uses: run.threads, or one for each core that this process may use.
[[nodiscard]] int thread_count(const Run& run);

}  // namespace isolux
