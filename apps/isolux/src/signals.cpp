#include "signals.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <pthread.h>

#include <csignal>
#include <system_error>
#include <utility>

namespace isolux {
namespace {

/// A hang-up that is ignored already, as nohup wants it, stays so.
bool hang_up_counts() {
  struct sigaction before {};
  return sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN;
}

}  // namespace

SignalWatcher::SignalWatcher(std::function<void()> end_at_once) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  if (hang_up_counts()) sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  const auto watch = [this, signals, end_at_once = std::move(end_at_once)](const std::stop_token& end) {
    int signal = 0;
    while (sigwait(&signals, &signal) == 0 && !end.stop_requested()) {
      if (stop_.stop_requested()) end_at_once();
      stop_.request_stop();
    }
  };
  try {
    thread_ = std::jthread(watch);
  } catch (const std::system_error& error) {
    throw Error(fmt::format("no thread can be started: {}", error.code().message()));
  }
}

SignalWatcher::~SignalWatcher() {
  thread_.request_stop();
  pthread_kill(thread_.native_handle(), SIGTERM);  // which is blocked there, and ends its waiting
}

}  // namespace isolux
