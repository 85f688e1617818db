#pragma once

#include <isolux/core/stopwatch.h>

#include <algorithm>

namespace isolux::bench {

/// The seconds that a suite may spend, dealt out piece by piece, so that it ends in time on any machine.
class Budget {
 public:
  explicit Budget(double seconds) : seconds_(seconds) {}

  [[nodiscard]] double left() const { return std::max(0.0, seconds_ - watch_.seconds()); }
  /// One of `pieces` equal parts of what is left.
  [[nodiscard]] double share(std::size_t pieces) const { return left() / double(std::max<std::size_t>(1, pieces)); }

 private:
  double seconds_;
  Stopwatch watch_;
};

/// The steps of a curve whose every step takes `growth` times as long as the one before it: as many as fit.
class Climb {
 public:
  Climb(double seconds, double growth) : seconds_(seconds), growth_(growth) {}

  /// To be asked before each step: true for the first one, then while the next is likely to end in time.
  [[nodiscard]] bool goes_on() {
    const double now = watch_.seconds();
    const bool fits = is_first_ || now + growth_ * (now - last_) <= seconds_;
    last_ = now;
    is_first_ = false;
    return fits;
  }

 private:
  double seconds_;
  double growth_;
  double last_ = 0.0;
  bool is_first_ = true;
  Stopwatch watch_;
};

}  // namespace isolux::bench
