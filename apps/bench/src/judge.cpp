#include "judge.h"

#include <fmt/format.h>

namespace isolux::bench {

Table Judge::table() const {
  Table table{.id = "all",
              .title = "Stress cases",
              .columns = {"law", "backend", "cases", "figure", "worst", "allowed", "verdict"}};
  table.sentence = "Each row is a law that has to hold however the volume looks, with the worst figure found.";
  for (const Verdict& v : verdicts_) {
    table.rows.push_back(
        {v.law, v.backend, v.cases, v.figure, v.worst, v.allowed, std::string(v.passes() ? "pass" : "**FAIL**")});
  }
  return table;
}

std::vector<std::string> Judge::failures() const {
  std::vector<std::string> failures;
  for (const Verdict& v : verdicts_) {
    if (!v.passes())
      failures.push_back(
          fmt::format("{} ({}): {} is {:.3g}, allowed is {:.3g}", v.law, v.backend, v.figure, v.worst, v.allowed));
  }
  return failures;
}

}  // namespace isolux::bench
