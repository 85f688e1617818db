#pragma once

#include <isolux/bake/stages.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "budget.h"
#include "figures.h"

namespace isolux::bench {

/// How much a suite does.
enum class Effort {
  kSmoke,  ///< a second or two: whether everything runs
  kQuick,  ///< under a minute on two cores
  kFull    ///< all sizes, a few minutes
};

/// What every suite is given.
struct SuiteContext {
  Effort effort = Effort::kQuick;
  Run run;
  Stages stages;
  std::string data_folder;  ///< of real volumes, "" if there is none
  std::function<void(std::string_view)> say;
  Budget budget{40.0};       ///< what the suite may spend
  double load_before = 0.0;  ///< of the machine, before the first suite

  /// The value for the smoke, the quick or the full run.
  template <class T>
  [[nodiscard]] T pick(T smoke, T quick, T full) const {
    return effort == Effort::kFull ? full : effort == Effort::kQuick ? quick : smoke;
  }
};

/// A benchmark of one stage or of the whole: run time against error.
struct Suite {
  std::string_view name;
  std::string_view title;
  std::string_view help;
  SuiteReport (*run)(const SuiteContext& context);
  double full_seconds;  ///< about what a full run spends
};

/// All suites, in the order of the report.
[[nodiscard]] const std::vector<Suite>& suites();

/// The budget of a suite: its full_seconds, less for lesser efforts.
[[nodiscard]] Budget budget_of(const Suite& suite, Effort effort);

/// "smoke", "quick" or "full".
[[nodiscard]] std::string_view effort_name(Effort effort);

}  // namespace isolux::bench
