#pragma once

#include <isolux/bake/stages.h>
#include <isolux/core/run.h>
#include <isolux/core/stopwatch.h>

#include <CLI/App.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "output_files.h"

namespace isolux {

/// What the command line asked for is wrong: exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One invocation: the backends, the common options, and the report that commands add to.
class Session {
 public:
  Session();

  /// --threads, --seed, --report, --quiet and --version of every command. Called behind all options of its own: none of
  /// them may be given "".
  void add_common_options(CLI::App& command);
  /// What runs once the whole command line was understood.
  void on_run(std::function<void()> action) { action_ = std::move(action); }
  /// Finds out first whether what is written has a place: require_output_files(). \throw IoError, UsageError
  void run_action();

  /// Every option that names a file says so here, whatever its command, when it is added.
  void reads(FileOption option) { read_.push_back(std::move(option)); }
  void reads(const CLI::Option* option) { reads(file_of(option)); }
  void writes(FileOption option) { written_.push_back(std::move(option)); }
  void writes(const CLI::Option* option) { writes(file_of(option)); }

  /// Runs `work`, counting its seconds under `stage` in the report.
  template <class Work>
  decltype(auto) timed(const std::string& stage, Work&& work) {
    const Stopwatch watch;
    struct Guard {
      Session& session;
      const std::string& stage;
      const Stopwatch& watch;
      ~Guard() { session.add_seconds(stage, watch.seconds()); }
    } guard{*this, stage, watch};
    return work();
  }
  void add_seconds(const std::string& stage, double seconds);

  [[nodiscard]] bool quiet() const { return quiet_; }
  /// One line for people, on stderr unless --quiet.
  void say(const std::string& line) const;
  /// `isolux: warning: ...` on stderr, also with --quiet.
  void warn(const std::string& line) const;

  Stages stages;
  Run run;
  nlohmann::json report;  ///< --report; commands add their figures

 private:
  void write_report() const;

  bool quiet_ = false;
  std::string report_path_;
  std::vector<FileOption> read_;
  std::vector<FileOption> written_;
  std::function<void()> action_;
};

}  // namespace isolux
