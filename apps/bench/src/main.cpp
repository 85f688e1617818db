#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/stopwatch.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "faults.h"
#include "report.h"
#include "suite.h"

namespace {

using namespace isolux;
using namespace isolux::bench;

struct Arguments {
  std::vector<std::string> names;
  std::string folder = "bench";
  Effort effort = Effort::kQuick;
  std::string fault;
  int threads = 0;
  std::uint64_t seed = 1;
};

/// Exit status of a finished parse, or -1 to go on.
int parse(int argc, char** argv, Arguments& arguments) {
  CLI::App app{"Run time against error of every stage; writes JSON, CSV, pictures and report.md", "isolux bench"};
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
  app.add_option("--threads", arguments.threads, "threads, 0 for all")->check(CLI::Range(0, 4096));
  app.add_option("--seed", arguments.seed, "seed of every random number")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return 0;
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "isolux: error: {}\n", error.what());
    return 2;
  }
  return -1;
}

/// 1 if a claim of a suite did not hold.
int run_suites(const Arguments& arguments) {
  SuiteContext context{.effort = arguments.effort,
                       .run = {.seed = arguments.seed, .threads = arguments.threads},
                       .stages = builtin_stages(),
                       .data_folder = {},
                       .say = [](std::string_view text) { fmt::print(stderr, "    {}\n", text); }};
  if (const char* folder = std::getenv("ISOLUX_DATA"); folder != nullptr) context.data_folder = folder;
  if (!arguments.fault.empty()) context.stages = with_fault(std::move(context.stages), arguments.fault);
  std::ifstream("/proc/loadavg") >> context.load_before;
  int status = 0;
  for (const Suite& suite : suites()) {
    const auto& names = arguments.names;
    if (!names.empty() && std::find(names.begin(), names.end(), suite.name) == names.end()) continue;
    fmt::print(stderr, "{}: {}\n", suite.name, suite.help);
    context.budget = budget_of(suite, context.effort);
    const Stopwatch watch;
    const SuiteReport report = suite.run(context);
    write_suite(arguments.folder, suite, report, context, watch.seconds());
    fmt::print(stderr, "    {:.1f} s\n", watch.seconds());
    for (const std::string& failure : report.failures) {
      fmt::print(stderr, "isolux: error: {}: {}\n", suite.name, failure);
      status = 1;
    }
  }
  write_report(arguments.folder, context);
  fmt::print("{}/report.md\n", arguments.folder);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Arguments arguments;
    const int status = parse(argc, argv, arguments);
    return status >= 0 ? status : run_suites(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "isolux: error: bench: {}\n", error.what());
    return 1;
  }
}
