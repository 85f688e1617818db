#pragma once

#include <ctime>

namespace isolux::test {

/// Seconds that this process's threads have worked since it began, together: what else a machine is busy with takes
/// none.
class ProcessorTime {
 public:
  [[nodiscard]] double seconds() const { return double(std::clock() - begin_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t begin_ = std::clock();
};

}  // namespace isolux::test
