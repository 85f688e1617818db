#pragma once

#include <cfenv>

namespace isolux {

/// While it lives, this thread computes as C++ programs do from their start: rounding to nearest, nothing flushed to
/// zero, and no trap where a number is divided by zero, overflows or is none. A host may have set all of this
/// otherwise (fesetround(), feenableexcept(), _MM_SET_FLUSH_ZERO_MODE()); it finds it again afterwards, flags included.
/// Costs some 100 ns.
class PlainFloats {
 public:
  PlainFloats() {
    std::fegetenv(&hosts_);
    std::fesetenv(FE_DFL_ENV);
  }
  PlainFloats(const PlainFloats&) = delete;
  PlainFloats& operator=(const PlainFloats&) = delete;
  ~PlainFloats() { std::fesetenv(&hosts_); }

 private:
  std::fenv_t hosts_{};
};

}  // namespace isolux
