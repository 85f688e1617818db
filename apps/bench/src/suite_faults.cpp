#include <fmt/format.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>
#include <utility>

#include "faults.h"
#include "judge.h"
#include "suites.h"
#include "tracer_laws.h"
#include "tracer_speed.h"

namespace isolux::bench {
namespace {

/// The verdicts of one law on all tracers, side by side.
Table side_by_side(const std::vector<std::pair<std::string, Judge>>& judged) {
  Table table{.id = "laws", .title = "The laws, tracer by tracer", .columns = {"law", "figure", "allowed"}};
  table.sentence =
      "The rows of the suite `stability`, of the healthy tracer and of those that are wrong or slow on purpose.";
  for (const auto& [name, judge] : judged) table.columns.push_back(name);
  for (const Verdict& first : judged.front().second.verdicts()) {
    std::vector<Cell> row{first.law, first.figure, first.allowed};
    for (const auto& [name, judge] : judged) {
      const auto& all = judge.verdicts();
      const auto same = std::find_if(all.begin(), all.end(), [&](const Verdict& w) { return w.law == first.law; });
      if (same == all.end()) {
        row.emplace_back(std::string());
      } else {
        row.emplace_back(fmt::format("{}{}", number_text(same->worst), same->passes() ? "" : " **FAIL**"));
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Plot speeds(const std::vector<std::string>& tracers, const SuiteContext& context) {
  Plot plot{.id = "speed",
            .title = "Rays a second with and without skipping (gen:gyroid, one thread)",
            .x_label = "grid points an axis",
            .y_label = "million rays a second"};
  plot.sentence =
      "What a change that loses an optimisation does to the picture of the suite `trace`: `no_skipping` is the scalar "
      "tracer without knowing where f can reach, so that a ray tests every cell on its way.";
  Run run = context.run;
  run.threads = 1;
  const auto sizes = context.pick<std::vector<int>>({17}, {33, 65, 129}, {33, 65, 129, 257});
  std::size_t pieces = sizes.size() * tracers.size();
  for (const std::string& name : tracers) {
    Series series{.name = name};
    for (const int n : sizes) {
      const Volume volume = sample_analytic_field("gyroid", n);
      const Estimate rate = tracer_speed(name, volume, 0.0f, run, context.budget.share(pieces--), context).mrays;
      series.points.push_back({double(n), rate.value, rate.low, rate.high});
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

SuiteReport run_faults(const SuiteContext& context) {
  SuiteReport report;
  SuiteContext ill = context;
  for (const Fault& fault : faults()) ill.stages = with_fault(std::move(ill.stages), fault.name);
  std::vector<std::string> tracers{default_tracer(context)};
  for (const Fault& fault : faults()) tracers.emplace_back(fault.name);

  Plot energy{.id = "furnace",
              .title = "White furnace with and without faults (gen:gyroid)",
              .x_label = "bounces",
              .y_label = "mean e over that of the healthy tracer",
              .x_axis = Axis::kLinear,
              .y_axis = Axis::kLinear};
  energy.sentence =
      "Light that is 2 % too dim stays so at any number of bounces; hits that get lost let light in too early; the "
      "slow "
      "tracer is right. Bars are 95 % intervals.";
  std::vector<std::pair<std::string, Judge>> judged;
  // A fault of 2 % needs no more cases to be seen, and these tracers are slow.
  SuiteContext brief = ill;
  if (brief.effort == Effort::kFull) brief.effort = Effort::kQuick;
  for (const std::string& name : tracers) {
    context.say(name);
    judged.emplace_back(name, Judge());
    try_laws(name, brief, 0.02 * context.budget.left(), judged.back().second);
    energy.series.push_back(furnace_energy(name, brief));
  }
  const std::vector<PlotPoint> healthy = energy.series.front().points;
  for (Series& series : energy.series) {
    for (std::size_t i = 0; i < healthy.size(); ++i) {
      for (double* y : {&series.points[i].y, &series.points[i].low, &series.points[i].high}) *y /= healthy[i].y;
    }
  }
  for (const auto& [name, judge] : judged) {
    const std::vector<std::string> found = judge.failures();
    report.highlights.push_back(fmt::format("`{}` fails {} of {} laws{}{}.", name, found.size(),
                                            judge.verdicts().size(),
                                            found.empty() ? "" : ", the first: ", found.empty() ? "" : found.front()));
    if (name == tracers.front()) {
      report.failures = found;
    } else if (found.empty()) {
      report.failures.push_back(fmt::format("the fault {} went unseen", name));
    }
  }
  report.figures.emplace_back(side_by_side(judged));
  report.figures.emplace_back(std::move(energy));
  report.figures.emplace_back(speeds({tracers.front(), "scalar", "no_skipping"}, ill));
  return report;
}

}  // namespace isolux::bench
