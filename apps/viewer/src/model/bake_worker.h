#pragma once

#include <isolux/core/run.h>
#include <isolux/volume_io/light_file.h>

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace isolux::viewer {

/// Bakes light once on a thread of its own.
class BakeWorker {
 public:
  /// What came of it: the light, or one line why not.
  struct Outcome {
    std::optional<LightFile> light;
    std::string error;
  };
  struct Progress {
    std::string stage;
    double fraction = 0.0;
  };

  /// Starts. `bake` gets a run with stop token and progress filled in; `on_change` is called on the worker's threads
  /// when there is progress or an outcome.
  BakeWorker(const Run& run, std::function<LightFile(const Run&)> bake, std::function<void()> on_change);
  BakeWorker(const BakeWorker&) = delete;
  BakeWorker& operator=(const BakeWorker&) = delete;
  /// Cancels it.
  ~BakeWorker() = default;

  [[nodiscard]] Progress progress() const;
  /// Once, when it is there.
  [[nodiscard]] std::optional<Outcome> take();

 private:
  mutable std::mutex mutex_;
  Progress progress_;
  std::optional<Outcome> outcome_;
  std::jthread thread_;  ///< last: it ends before what it uses
};

}  // namespace isolux::viewer
