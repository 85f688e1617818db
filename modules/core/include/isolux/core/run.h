#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>

namespace isolux {

/// How a long operation runs; the same for every stage. The result never depends on `threads`.
struct Run {
  std::uint64_t seed = 1;
  int threads = 0;         ///< 0: all the machine has
  std::stop_token stop{};  ///< when triggered the operation throws Cancelled soon
  /// Called now and then with the stage's name and the part done (0 to 1), from any thread but never from two at once.
  std::function<void(std::string_view stage, double fraction)> progress{};
};

/// \throw Cancelled if the run was asked to stop.
void throw_if_stopped(const Run& run);

/// A run whose progress is that of the part from `begin` to `end` (of 1) of a longer one, which outlives it.
[[nodiscard]] Run part_of(const Run& run, double begin, double end);

}  // namespace isolux
