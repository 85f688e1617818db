#include "signals.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>

namespace isolux {

SignalWatcher::SignalWatcher() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  thread_ = std::jthread([this, signals](const std::stop_token& end) {
    int signal = 0;
    while (sigwait(&signals, &signal) == 0 && !end.stop_requested()) {
      if (stop_.stop_requested()) _exit(130);
      stop_.request_stop();
    }
  });
}

SignalWatcher::~SignalWatcher() {
  thread_.request_stop();
  pthread_kill(thread_.native_handle(), SIGTERM);  // which is blocked there, and ends its waiting
}

}  // namespace isolux
