#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/stopwatch.h>
#include <isolux/volume_io/atomic_file.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "faults.h"
#include "program.h"
#include "report.h"
#include "session.h"
#include "suite.h"
#include "terminal.h"
#include "usage.h"

namespace {

using namespace isolux;
using namespace isolux::bench;
namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> names;
  std::string folder = "bench";
  Effort effort = Effort::kQuick;
  std::string fault;
};

/// Exit status of a finished parse, or -1 to go on. The session asks for the options of `app` later, too. \throw
/// UsageError, IoError
int parse(int argc, char** argv, CLI::App& app, Arguments& arguments, Session& session) {
  std::vector<std::string> known;
  std::string footer = "Suites (default: all):\n";
  for (const Suite& suite : suites()) {
    known.emplace_back(suite.name);
    footer += fmt::format("  {:<12}{}\n", suite.name, suite.help);
  }
  app.footer(footer + "Real volumes are taken from the folder that the environment variable ISOLUX_DATA names.");
  app.add_option("SUITE", arguments.names, "suites to run")->check(CLI::IsMember(known));
  app.add_option("-o,--output", arguments.folder, "folder for the results")->type_name("DIR")->capture_default_str();
  app.add_flag(
      "--quick{1},--full{2},--smoke{0}", arguments.effort,
      "under a minute a suite on two cores (default); all sizes, some twenty minutes in all; seconds in all, to "
      "see that everything runs");
  std::vector<std::string> ills;
  for (const Fault& fault : faults()) ills.emplace_back(fault.name);
  app.add_option("--inject", arguments.fault,
                 "judge a tracer that is wrong or slow on purpose, as if it were the default")
      ->check(CLI::IsMember(ills));
  session.add_common_options(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return print_help(app, help);
  } catch (const CLI::ParseError& error) {
    throw UsageError(explain(error, app));
  }
  if (app.count("--quick") > 1) throw UsageError("--quick, --full, --smoke: only one of them can be meant");
  return -1;
}

/// The results' folder, made before the first suite, so that no minutes are lost to one that cannot be. Folders that
/// were made and stay empty, as no suite ended, go again.
class ResultFolder {
 public:
  /// \throw IoError
  explicit ResultFolder(const fs::path& folder) {
    std::error_code error;
    for (fs::path missing = fs::absolute(folder, error);
         !error && !fs::exists(missing, error) && missing.has_parent_path(); missing = missing.parent_path())
      made_.push_back(missing);
    fs::create_directories(folder, error);
    if (error) throw IoError(fmt::format("{}: cannot be made a folder: {}", folder.string(), error.message()));
  }
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;
  ~ResultFolder() {
    std::error_code ignored;
    for (const fs::path& folder : made_) fs::remove(folder, ignored);
  }

 private:
  std::vector<fs::path> made_;  ///< the innermost first
};

/// 1 if a claim of a suite did not hold.
int run_suites(const Arguments& arguments, Session& session) {
  const ResultFolder folder(arguments.folder);
  require_writable((fs::path(arguments.folder) / "report.md").string());
  SuiteContext context{.effort = arguments.effort,
                       .run = {.seed = session.run.seed, .threads = session.run.threads, .stop = session.run.stop},
                       .stages = builtin_stages(),
                       .data_folder = {},
                       .say = [&session](std::string_view text) { session.say(fmt::format("    {}", text)); }};
  if (const char* data = std::getenv("ISOLUX_DATA"); data != nullptr) context.data_folder = data;
  if (!arguments.fault.empty()) context.stages = with_fault(std::move(context.stages), arguments.fault);
  std::ifstream("/proc/loadavg") >> context.load_before;
  int status = 0;
  for (const Suite& suite : suites()) {
    const auto& names = arguments.names;
    if (!names.empty() && std::find(names.begin(), names.end(), suite.name) == names.end()) continue;
    throw_if_stopped(session.run);
    session.say(fmt::format("{}: {}", suite.name, suite.help));
    context.budget = budget_of(suite, context.effort);
    const Stopwatch watch;
    const SuiteReport report = suite.run(context);
    write_suite(arguments.folder, suite, report, context, watch.seconds());
    session.add_seconds(std::string(suite.name), watch.seconds());
    session.say(fmt::format("    {:.1f} s", watch.seconds()));
    for (const std::string& failure : report.failures) {
      complain(std::string(suite.name), failure);
      status = 1;
    }
  }
  write_report(arguments.folder, context);
  fmt::print("{}/report.md\n", arguments.folder);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("bench", [&](Session& session, std::string& /*what*/) {
    CLI::App app{"Run time against error of every stage; writes JSON, CSV, pictures and report.md", "isolux bench"};
    Arguments arguments;
    int status = parse(argc, argv, app, arguments, session);
    if (status >= 0) return status;
    session.on_run([&] { status = run_suites(arguments, session); });
    session.run_action();
    return status;
  });
}
