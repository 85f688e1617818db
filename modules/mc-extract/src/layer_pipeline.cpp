#include "layer_pipeline.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace isolux::mc {

LayerPipeline::LayerPipeline(int layers, Stages stages)
    : layers_(layers),
      stages_(std::move(stages)),
      bodies_{&stages_.classify, &stages_.count, &stages_.write, &stages_.connect},
      classified_(std::size_t(layers), 0),
      counted_(std::size_t(layers), 0) {
  for (int s = 0; s < kStages; ++s)
    if (!*bodies_[s]) next_[s] = layers_;
}

void LayerPipeline::run(const Run& run) {
  ahead_ += thread_count(run);
  // Whoever waits here waits for a task that another thread is at, so any number of these may run at once, one too.
  parallel_blocks(std::size_t(thread_count(run)), 1, run, "", [&](const Block&) { work(run); });
}

void LayerPipeline::work(const Run& run) {
  try {
    for (Task task;;) {
      throw_if_stopped(run);
      const Next next = take(task);
      if (next == Next::kEnd) return;
      if (next == Next::kWait) {
        std::this_thread::yield();
        continue;
      }
      (*bodies_[task.stage])(task.layer);
      finish(task);
    }
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    failed_ = true;
    throw;
  }
}

LayerPipeline::Next LayerPipeline::take(Task& task) {
  std::unique_lock lock(mutex_);
  if (failed_) return Next::kEnd;
  if (must_grow_ && writing_ == 0) {
    stages_.grow();
    must_grow_ = false;
    number_counted(lock);
  }
  for (const Stage stage : {kConnect, kWrite, kCount, kClassify}) {
    if (!ready(stage)) continue;
    task = {.stage = stage, .layer = next_[stage]++};
    if (stage >= kWrite) ++writing_;
    return Next::kTask;
  }
  const bool all_taken = std::all_of(next_.begin(), next_.end(), [&](int next) { return next == layers_; });
  return all_taken ? Next::kEnd : Next::kWait;
}

bool LayerPipeline::ready(Stage stage) const {
  const int layer = next_[stage];
  if (layer == layers_) return false;
  const int above = std::min(layer + 2, layers_);
  switch (stage) {
    case kClassify:
      return layer < std::min(next_[kWrite], numbered_) + ahead_;
    case kCount:
      return classified_up_to_ >= above;
    case kWrite:
      return numbered_ > layer && !must_grow_;
    default:
      return numbered_ >= above && !must_grow_;
  }
}

void LayerPipeline::finish(const Task& task) {
  std::unique_lock lock(mutex_);
  if (task.stage >= kWrite) {
    --writing_;
    return;
  }
  (task.stage == kClassify ? classified_ : counted_)[std::size_t(task.layer)] = 1;
  while (classified_up_to_ < layers_ && classified_[std::size_t(classified_up_to_)] != 0) ++classified_up_to_;
  number_counted(lock);
}

void LayerPipeline::number_counted(std::unique_lock<std::mutex>& lock) {
  // One thread at a time, without the lock: others go on with what is ready.
  if (numbering_) return;
  numbering_ = true;
  while (numbered_ < layers_ && counted_[std::size_t(numbered_)] != 0 && !must_grow_) {
    lock.unlock();
    const bool must_grow = stages_.number(numbered_);
    lock.lock();
    must_grow_ = must_grow;
    ++numbered_;
  }
  numbering_ = false;
}

}  // namespace isolux::mc
