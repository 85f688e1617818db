#pragma once

#include <isolux/bake/stages.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "figures.h"

namespace isolux::bench {

/// What every suite is given.
struct SuiteContext {
  bool full = false;  ///< all sizes; otherwise under a minute on two cores
  Run run;
  Stages stages;
  std::string data_folder;  ///< of real volumes, "" if there is none
  std::function<void(std::string_view)> say;

  /// The value for the quick or for the full mode.
  template <class T>
  [[nodiscard]] T pick(T quick_value, T full_value) const {
    return full ? full_value : quick_value;
  }
};

/// A benchmark of one stage or of the whole: run time against error.
struct Suite {
  std::string_view name;
  std::string_view title;
  std::string_view help;
  SuiteReport (*run)(const SuiteContext& context);
};

/// All suites, in the order of the report.
[[nodiscard]] const std::vector<Suite>& suites();

}  // namespace isolux::bench
