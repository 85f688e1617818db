#include "model/bake_worker.h"

#include <exception>
#include <utility>

namespace isolux::viewer {

BakeWorker::BakeWorker(const Run& run, std::function<LightFile(const Run&)> bake, std::function<void()> on_change)
    : thread_([this, run, bake = std::move(bake), on_change = std::move(on_change)](const std::stop_token& stop) {
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
          outcome.light = bake(watched);
        } catch (const std::exception& error) {
          outcome.error = error.what();
        }
        {
          const std::scoped_lock lock(mutex_);
          outcome_ = std::move(outcome);
        }
        on_change();
      }) {}

BakeWorker::Progress BakeWorker::progress() const {
  const std::scoped_lock lock(mutex_);
  return progress_;
}

std::optional<BakeWorker::Outcome> BakeWorker::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(outcome_, std::nullopt);
}

}  // namespace isolux::viewer
