#pragma once

#include <limits>
#include <string>

namespace isolux {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// What a control group, as of a container or of a batch job, lets its programs have: kNoLimit where nothing is said.
struct GroupMemory {
  double most;  ///< bytes in all
  double left;  ///< bytes that are not taken yet; what caches files counts as left
};

/// That of this process's group and those above it, whichever is least, of both versions of Linux's control groups;
/// files are looked up in the folder `root`, which is the system's own, "", but for tests.
[[nodiscard]] GroupMemory group_memory(const std::string& root = "");

}  // namespace isolux
