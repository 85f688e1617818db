#include "model/surface_worker.h"

#include <isolux/core/error.h>

#include <utility>

namespace isolux::viewer {

SurfaceWorker::SurfaceWorker(Extract extract, std::function<void()> on_ready)
    : extract_(std::move(extract)),
      on_ready_(std::move(on_ready)),
      thread_([this](std::stop_token stop) { work(std::move(stop)); }) {}

void SurfaceWorker::request(const ExtractSettings& settings) {
  {
    const std::scoped_lock lock(mutex_);
    wanted_ = settings;
  }
  wake_.notify_one();
}

void SurfaceWorker::recycle(IndexedMesh mesh) {
  const std::scoped_lock lock(mutex_);
  spare_ = std::move(mesh);
}

std::optional<Surface> SurfaceWorker::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(ready_, std::nullopt);
}

bool SurfaceWorker::idle() const {
  const std::scoped_lock lock(mutex_);
  return !wanted_ && !busy_ && !ready_;
}

void SurfaceWorker::work(std::stop_token stop) {
  while (true) {
    ExtractSettings settings;
    IndexedMesh memory;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return wanted_.has_value(); })) return;
      settings = *std::exchange(wanted_, std::nullopt);
      memory = std::exchange(spare_, {});
      busy_ = true;
    }
    try {
      Surface surface = extract_(settings, std::move(memory), stop);
      const std::scoped_lock lock(mutex_);
      ready_ = std::move(surface);
      busy_ = false;
    } catch (const Cancelled&) {
      return;
    }
    on_ready_();
  }
}

}  // namespace isolux::viewer
