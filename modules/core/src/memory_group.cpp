#include "memory_group.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace isolux {
namespace {

// Paths are strings here: where memory ends, those of libstdc++ 12 are freed twice, and who asks is short of it.

/// The files of one version of control groups.
struct GroupFiles {
  const char* mount;
  const char* most;
  const char* taken;
  const char* cache;  ///< the word before that number in memory.stat
};
constexpr GroupFiles kFirstVersion{"/sys/fs/cgroup/memory", "/memory.limit_in_bytes", "/memory.usage_in_bytes",
                                   "total_inactive_file"};
constexpr GroupFiles kSecondVersion{"/sys/fs/cgroup", "/memory.max", "/memory.current", "inactive_file"};

/// The number that a file begins with; `otherwise` where there is none, as in "max".
double number_in(const std::string& file, double otherwise) {
  std::ifstream in(file);
  double number = 0.0;
  return in >> number ? number : otherwise;
}

/// The number behind a word of a file; 0 if it is not there.
double number_behind(const std::string& file, const std::string& word) {
  std::ifstream in(file);
  double number = 0.0;
  for (std::string read; in >> read >> number;)
    if (read == word) return number;
  return 0.0;
}

GroupMemory of_group(const std::string& group, const GroupFiles& files) {
  const double most = number_in(group + files.most, kNoLimit);
  if (most == kNoLimit) return {kNoLimit, kNoLimit};
  const double cache = number_behind(group + "/memory.stat", files.cache);
  return {most, std::clamp(most - number_in(group + files.taken, 0.0) + cache, 0.0, most)};
}

}  // namespace

GroupMemory group_memory(const std::string& root) {
  GroupMemory least{kNoLimit, kNoLimit};
  // Each line: a number, what the group is for, its path; of the second version the middle is empty.
  std::ifstream groups(root + "/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string purposes = "," + line.substr(first + 1, second - first - 1) + ",";
    if (purposes != ",," && purposes.find(",memory,") == std::string::npos) continue;
    const GroupFiles& files = purposes == ",," ? kSecondVersion : kFirstVersion;
    // A container sees its own group as the highest, whatever its path is outside.
    std::string group = line.substr(second + 1);
    for (;; group.resize(group.rfind('/'))) {
      const GroupMemory found = of_group(root + files.mount + group, files);
      least = {std::min(least.most, found.most), std::min(least.left, found.left)};
      if (group.rfind('/') == std::string::npos) break;
    }
  }
  return least;
}

}  // namespace isolux
