#include "session.h"

#include <fmt/format.h>
#include <isolux/volume_io/atomic_file.h>
#include <sys/resource.h>

#include <cstdio>
#include <limits>

#include "progress.h"

namespace isolux {

Session::Session() : stages(builtin_stages()), report(nlohmann::json::object()) {
  report["seconds"] = nlohmann::json::object();
}

void Session::add_common_options(CLI::App& command) {
  command.add_option("--threads", run.threads, "threads to use (default: all)")
      ->check(CLI::Range(1, 4096))
      ->type_name("T");
  command.add_option("--seed", run.seed, "seed of all random numbers (default 1)")->type_name("S");
  command.add_option("--report", report_path_, "write what was done and how long it took, as JSON")
      ->type_name("FILE.json");
  command.add_flag("--quiet", quiet_, "no progress and no remarks");
}

void Session::run_action() {
  if (!quiet_) run.progress = make_progress();
  const Stopwatch total;
  action_();
  add_seconds("total", total.seconds());
  if (!report_path_.empty()) write_report();
}

void Session::add_seconds(const std::string& stage, double seconds) {
  auto& slot = report["seconds"][stage];
  slot = (slot.is_number() ? slot.get<double>() : 0.0) + seconds;
}

void Session::write_report() const {
  nlohmann::json complete = report;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  complete["peak_memory_bytes"] = std::int64_t(usage.ru_maxrss) * 1024;
  complete["settings"]["threads"] = run.threads;
  complete["settings"]["seed"] = run.seed;
  write_atomically(report_path_, [&](std::ostream& out) { out << complete.dump(2) << '\n'; });
}

void Session::say(const std::string& line) const {
  if (!quiet_) fmt::print(stderr, "{}\n", line);
}

void Session::warn(const std::string& line) const { fmt::print(stderr, "isolux: warning: {}\n", line); }

}  // namespace isolux
