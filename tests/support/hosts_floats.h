#pragma once

#include <cfenv>

namespace isolux::test {

/// While it lives, this thread, and threads that it starts, trap invalid numbers, divisions by zero and overflow where
/// the processor can, as in programs that debug theirs so, and round upwards.
class HostsFloats {
 public:
  HostsFloats() {
    std::fegetenv(&before_);
    std::fesetround(FE_UPWARD);
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  }
  HostsFloats(const HostsFloats&) = delete;
  HostsFloats& operator=(const HostsFloats&) = delete;
  ~HostsFloats() { std::fesetenv(&before_); }

 private:
  std::fenv_t before_{};
};

}  // namespace isolux::test
