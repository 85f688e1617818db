#include <fmt/format.h>
#include <isolux/bake/version.h>
#include <isolux/core/machine_memory.h>
#include <isolux/core/parallel.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <string>

#include "peer_embree.h"
#include "peer_vtk.h"
#include "report.h"

namespace isolux::bench {
namespace {

/// The first line of /proc/cpuinfo that starts with `key`, after its colon.
std::string cpu_info(const std::string& key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string vector_extensions() {
  const std::string flags = " " + cpu_info("flags") + " " + cpu_info("Features") + " ";  // the latter on Arm
  std::string found;
  for (const char* name : {"sse4_2", "avx2", "fma", "avx512f", "asimd"}) {
    if (flags.find(fmt::format(" {} ", name)) != std::string::npos) found += fmt::format(" {}", name);
  }
  return found;
}

}  // namespace

std::string machine_description(const SuiteContext& context) {
  utsname system{};
  uname(&system);
  const double gib = machine_memory() / double(1 << 30);
  const std::time_t now = std::time(nullptr);
  std::tm day{};
  gmtime_r(&now, &day);
  std::string text = "| machine | |\n| --- | --- |\n";
  text += fmt::format("| isolux | {} |\n", kVersion);
  text += fmt::format("| processor | {}, {} logical processors,{} |\n", cpu_info("model name"), thread_count({}),
                      vector_extensions());
  text += fmt::format("| load of the machine when the suites began | {:.2f} |\n", context.load_before);
  text += fmt::format("| memory | {:.1f} GiB |\n", gib);
  text += fmt::format("| system | {} {} {} |\n", system.sysname, system.release, system.machine);
  text += fmt::format("| compiler | {} {}, flags `{}` |\n", ISOLUX_BENCH_COMPILER, __VERSION__, ISOLUX_BENCH_FLAGS);
  text += fmt::format("| threads used | {} |\n| seed | {} |\n", thread_count(context.run), context.run.seed);
  text += fmt::format("| Embree | {} |\n| VTK | {} |\n", embree_version(), vtk_version());
  text += fmt::format("| real volumes | {} |\n", context.data_folder.empty() ? "none (ISOLUX_DATA is not set)" : "yes");
  text += fmt::format("| day | {:04}-{:02}-{:02} |\n", day.tm_year + 1900, day.tm_mon + 1, day.tm_mday);
  return text;
}

}  // namespace isolux::bench
