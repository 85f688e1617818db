#pragma once

#include <stop_token>
#include <thread>

namespace isolux {

/// Turns the first SIGINT or SIGTERM into a stop request, so that work ends cleanly, and the second into an immediate
/// exit with 130. Made before any other thread.
class SignalWatcher {
 public:
  SignalWatcher();
  ~SignalWatcher();
  SignalWatcher(const SignalWatcher&) = delete;
  SignalWatcher& operator=(const SignalWatcher&) = delete;
  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  std::stop_source stop_;
  std::jthread thread_;
};

}  // namespace isolux
