#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "model/surface.h"

namespace isolux::viewer {

/// Extracts surfaces on a thread of its own, so that the window stays responsive. Only the newest request counts: those
/// that arrive while a surface is made replace each other.
class SurfaceWorker {
 public:
  using Extract = std::function<Surface(const ExtractSettings& settings, IndexedMesh memory, std::stop_token stop)>;

  /// `on_ready` is called on the worker's thread after each surface.
  SurfaceWorker(Extract extract, std::function<void()> on_ready);
  SurfaceWorker(const SurfaceWorker&) = delete;
  SurfaceWorker& operator=(const SurfaceWorker&) = delete;
  /// Cancels what is under way.
  ~SurfaceWorker() = default;

  void request(const ExtractSettings& settings);
  /// A mesh that is no longer needed: its memory serves for the next surface.
  void recycle(IndexedMesh mesh);
  /// The newest surface that was not taken yet.
  [[nodiscard]] std::optional<Surface> take();
  /// Nothing is asked for, under way or ready to be taken.
  [[nodiscard]] bool idle() const;

 private:
  void work(std::stop_token stop);

  Extract extract_;
  std::function<void()> on_ready_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<ExtractSettings> wanted_;
  std::optional<Surface> ready_;
  IndexedMesh spare_;
  bool busy_ = false;
  std::jthread thread_;  ///< last: it ends before what it uses
};

}  // namespace isolux::viewer
