#pragma once

#include <functional>
#include <stop_token>
#include <thread>

namespace isolux {

/// Turns the first SIGINT, SIGTERM or SIGHUP into a stop request, so that work ends cleanly. At the second one it calls
/// `end_at_once`, from a thread of its own. Made before any other thread.
class SignalWatcher {
 public:
  /// \throw Error where the system has no thread left
  explicit SignalWatcher(std::function<void()> end_at_once);
  ~SignalWatcher();
  SignalWatcher(const SignalWatcher&) = delete;
  SignalWatcher& operator=(const SignalWatcher&) = delete;
  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  std::stop_source stop_;
  std::jthread thread_;
};

}  // namespace isolux
