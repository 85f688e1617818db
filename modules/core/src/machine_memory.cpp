#include <isolux/core/machine_memory.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

#include "memory_group.h"

namespace isolux {
namespace {

/// The bytes that a file of the system's says behind a word, in units of 1024.
std::optional<std::uint64_t> bytes_behind(const char* file, const std::string& word) {
  std::ifstream in(file);
  for (std::string read; in >> read;) {
    std::uint64_t kilobytes = 0;
    if (read == word && in >> kilobytes) return kilobytes * 1024;
  }
  return std::nullopt;
}

}  // namespace

double machine_memory() {
  const double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  return std::min(bytes > 0.0 ? bytes : kNoLimit, group_memory().most);
}

double free_addresses() {
  rlimit own{};
  const auto taken = bytes_behind("/proc/self/status", "VmSize:");
  const bool is_limited = getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY && taken;
  return is_limited ? std::max(0.0, double(own.rlim_cur) - double(*taken)) : kNoLimit;
}

double free_memory() {
  const auto available = bytes_behind("/proc/meminfo", "MemAvailable:");
  // Hardly anything has more addresses than it uses.
  return std::min({available ? double(*available) : kNoLimit, group_memory().left, free_addresses()});
}

std::uint64_t peak_memory() {
  // getrusage() knows the peak of the program that began this one, too, from before it became this one.
  if (const auto bytes = bytes_behind("/proc/self/status", "VmHWM:")) return *bytes;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::uint64_t(usage.ru_maxrss) * 1024;
}

}  // namespace isolux
