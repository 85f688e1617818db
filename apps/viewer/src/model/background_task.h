#pragma once

#include <isolux/core/run.h>

#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace isolux::viewer {

/// Makes one result on a thread of its own.
template <class Result>
class BackgroundTask {
 public:
  /// What came of it: the result, or one line why not.
  struct Outcome {
    std::optional<Result> result;
    std::string error;
  };
  struct Progress {
    std::string stage;
    double fraction = 0.0;
  };

  /// Starts. `make` gets a run with stop token and progress filled in; `on_change` is called on the worker's threads
  /// when there is progress or an outcome.
  BackgroundTask(const Run& run, std::function<Result(const Run&)> make, std::function<void()> on_change)
      : thread_([this, run, make = std::move(make), on_change = std::move(on_change)](const std::stop_token& stop) {
          Run watched = run;
          watched.stop = stop;
          watched.progress = [&](std::string_view stage, double fraction) {
            {
              const std::scoped_lock lock(mutex_);
              progress_ = {std::string(stage), fraction};
            }
            on_change();
          };
          Outcome outcome;
          try {
            outcome.result = make(watched);
          } catch (const std::exception& error) {
            outcome.error = error.what();
          }
          {
            const std::scoped_lock lock(mutex_);
            outcome_ = std::move(outcome);
          }
          on_change();
        }) {}
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;
  /// Cancels it.
  ~BackgroundTask() = default;

  [[nodiscard]] Progress progress() const {
    const std::scoped_lock lock(mutex_);
    return progress_;
  }
  /// Once, when it is there.
  [[nodiscard]] std::optional<Outcome> take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(outcome_, std::nullopt);
  }

 private:
  mutable std::mutex mutex_;
  Progress progress_;
  std::optional<Outcome> outcome_;
  std::jthread thread_;  ///< last: it ends before what it uses
};

}  // namespace isolux::viewer
