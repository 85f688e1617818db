#pragma once

#include <isolux/core/run.h>

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

namespace isolux::mc {

/// The stages of layer after layer, by several threads with nothing to wait for between stages: whoever is free takes
/// the latest stage that is ready, so that values and bits are still in the cache when they are used again. Waking and
/// gathering threads for every few layers instead cost a third of two threads' gain.
class LayerPipeline {
 public:
  /// Each is called once for every layer, from any thread, but `number` in rising order and never two at once. A layer
  /// is counted when the next one is classified, written when it is numbered, connected when the next one is too.
  struct Stages {
    std::function<void(int layer)> classify;
    std::function<void(int layer)> count;
    std::function<bool(int layer)> number;  ///< whether memory must grow before anything more is written
    std::function<void()> grow;             ///< called while nothing is written
    std::function<void(int layer)> write;   ///< may be empty, as may `connect`
    std::function<void(int layer)> connect;
  };

  LayerPipeline(int layers, Stages stages);

  /// \throw Cancelled, and what a stage throws.
  void run(const Run& run);

 private:
  enum Stage : std::uint8_t { kClassify, kCount, kWrite, kConnect, kStages };
  enum class Next : std::uint8_t { kTask, kWait, kEnd };
  struct Task {
    Stage stage = kClassify;
    int layer = 0;
  };

  void work(const Run& run);
  [[nodiscard]] Next take(Task& task);
  [[nodiscard]] bool ready(Stage stage) const;
  void finish(const Task& task);
  void number_counted(std::unique_lock<std::mutex>& lock);

  int layers_;
  int ahead_ = 2;  ///< layers that classifying may be before writing, and as many more as there are threads
  Stages stages_;
  std::array<const std::function<void(int)>*, kStages> bodies_;
  std::mutex mutex_;
  std::array<int, kStages> next_{};  ///< of each stage, the next layer to be taken
  std::vector<std::uint8_t> classified_, counted_;
  int classified_up_to_ = 0;
  int numbered_ = 0;
  int writing_ = 0;  ///< tasks under way that write
  bool numbering_ = false;
  bool must_grow_ = false;
  bool failed_ = false;
};

}  // namespace isolux::mc
