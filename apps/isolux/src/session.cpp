#include "session.h"

#include <fmt/format.h>
#include <isolux/bake/version.h>
#include <isolux/core/machine_memory.h>
#include <isolux/core/options.h>
#include <isolux/core/parallel.h>
#include <isolux/volume_io/atomic_file.h>

#include <limits>

#include "progress.h"
#include "terminal.h"
#include "usage.h"

namespace isolux {
namespace {

/// Isovalues are floats: as doubles they would have digits that nobody gave.
void shorten_isovalues(nlohmann::json& settings) {
  const auto shorten = [](nlohmann::json& value) {
    if (value.is_number_float()) value = parse_number("isovalue", fmt::format("{}", value.get<float>()));
  };
  if (const auto isovalue = settings.find("isovalue"); isovalue != settings.end()) shorten(*isovalue);
  if (const auto range = settings.find("iso_range"); range != settings.end())
    for (nlohmann::json& end : *range) shorten(end);
}

}  // namespace

Session::Session() : stages(builtin_stages()), report(nlohmann::json::object()) {
  report["seconds"] = nlohmann::json::object();
}

void Session::add_common_options(CLI::App& command) {
  command.add_option("--threads", run.threads, "threads to use (default: all)")
      ->transform(whole_number(1, 4096))
      ->type_name("T");
  command.add_option("--seed", run.seed, "seed of all random numbers (default 1)")
      ->transform(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->type_name("S");
  writes(command.add_option("--report", report_path_, "write what was done and how long it took, as JSON")
             ->type_name("FILE.json"));
  command.add_flag("--quiet", quiet_, "no progress and no remarks");
  if (command.get_version_ptr() == nullptr) command.set_version_flag("--version", std::string("isolux ") + kVersion);
  for (CLI::Option* option : command.get_options()) {
    if (option->get_items_expected_max() > 0) option->check(something());
  }
}

void Session::run_action() {
  if (!quiet_) run.progress = make_progress();
  require_output_files(written_, read_);
  for (const FileOption& option : written_) {
    if (option.name != "--output" && option.name != "OUT") continue;
    if (const auto paths = option.paths(); !paths.empty()) report["output"] = paths.front();
  }
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
  complete["peak_memory_bytes"] = peak_memory();
  complete["version"] = kVersion;
  complete["settings"]["threads"] = thread_count(run);
  complete["settings"]["seed"] = run.seed;
  shorten_isovalues(complete["settings"]);
  if (const auto surfaces = complete.find("surfaces"); surfaces != complete.end())
    for (nlohmann::json& surface : *surfaces) shorten_isovalues(surface["settings"]);
  write_atomically(report_path_, [&](std::ostream& out) {
    out << complete.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  });
}

void Session::say(const std::string& line) const {
  if (!quiet_) tell(line + "\n");
}

void Session::warn(const std::string& line) const { isolux::warn(line); }

}  // namespace isolux
