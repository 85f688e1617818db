#include <fmt/format.h>
#include <isolux/core/random.h>
#include <isolux/raytrace_flat/level_set_intersector.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "judge.h"
#include "stats.h"
#include "stress_volumes.h"
#include "suites.h"
#include "tracer_laws.h"
#include "tracer_speed.h"

namespace isolux::bench {
namespace {

Vec3 random_direction(RandomStream& random) {
  const double z = 2.0 * random.uniform_double() - 1.0;
  const double angle = 2.0 * std::numbers::pi * random.uniform_double();
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Rays in a volume and in its transformed copy: the same hits.
void invariance(const SuiteContext& context, Judge& judge, const std::string& what, const Transformed& pair) {
  const LevelSetIntersector before(pair.volume);
  const LevelSetIntersector after(pair.transformed);
  const Sites sites = context.stages.samplers.create("random")->sample(
      pair.volume,
      {.texels = cell_lattice(pair.volume.lattice()), .count = std::size_t(context.pick(2000, 20000, 400000))},
      context.run);
  double worst = 0.0;
  double disagreements = 0.0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    RandomStream random(context.run.seed, i, 3);
    const Vec3 direction = random_direction(random);
    const Vec3 origin(sites.positions[i]);
    const auto hit = before.next_hit(origin, direction, sites.isovalues[i], OuterSide::kLower);
    const auto other =
        after.next_hit(pair.position(origin), pair.direction(direction), pair.isovalue(sites.isovalues[i]), pair.outer);
    if (hit.has_value() != other.has_value() || (hit && std::fabs(hit->t - other->t) > 1e-3)) {
      disagreements += 1.0;
    } else if (hit) {
      worst = std::max(worst, std::fabs(hit->t - other->t));
    }
  }
  const auto rays = double(sites.size());
  judge.add({what, "intersector", rays, "largest change of t, cells", worst, 1e-4});
  // Where a root is double to rounding, either answer is right: rays that graze, some in a million.
  judge.add({what, "intersector", rays, "hits that changed, per million", 1e6 * disagreements / rays, 100.0});
}

/// Constant light stays constant through every resampler.
void constants(const SuiteContext& context, Judge& judge) {
  const Volume volume = sample_analytic_field("gyroid", 17);
  for (const BackendInfo& info : context.stages.resamplers.backends()) {
    if (!info.unavailable.empty()) continue;
    const std::string sampler = info.name == "direct" ? "texels" : "random";
    const Lattice texels = cell_lattice(volume.lattice());
    SampleSet samples;
    samples.sites =
        context.stages.samplers.create(sampler)->sample(volume, {.texels = texels, .count = 2000}, context.run);
    samples.radiance.assign(samples.size(), 0.7f);
    samples.variance.assign(samples.size(), 0.01f);
    const ResampledGrid result =
        context.stages.resamplers.create(info.name)->resample(volume, samples, texels, context.run);
    double worst = 0.0;
    for (std::size_t t = 0; t < result.lit.size(); ++t) {
      if (result.lit[t] != 0) worst = std::max(worst, std::fabs(double(result.grid.values[t]) - double(0.7f)));
    }
    judge.add({"constant light", info.name, double(result.lit.size()), "largest change", worst, 1e-6});
  }
}

}  // namespace

SuiteReport run_stability(const SuiteContext& context) {
  SuiteReport report;
  Judge judge;
  Plot energy{.id = "furnace",
              .title = "White furnace: mean e over bounces (gen:gyroid)",
              .x_label = "bounces",
              .y_label = "mean e",
              .x_axis = Axis::kLinear,
              .y_axis = Axis::kLinear};
  energy.sentence =
      "Albedo 1 under uniform light: every bounce brings e nearer to 1 and none past it; bars are 95 % intervals.";
  const std::vector<std::string> names = tracer_names(context);
  for (std::size_t i = 0; i < names.size(); ++i) {
    context.say(names[i]);
    try_laws(names[i], context, 0.7 * context.budget.share(names.size() - i), judge);
    energy.series.push_back(furnace_energy(names[i], context));
  }
  context.say("invariance");
  for (const auto& [what, pair] : transformations(context.run)) invariance(context, judge, what, pair);
  constants(context, judge);
  report.failures = judge.failures();
  report.highlights.push_back(fmt::format("{} of {} laws hold; the worst figure of each stands in the table.",
                                          judge.verdicts().size() - report.failures.size(), judge.verdicts().size()));
  report.figures.emplace_back(judge.table());
  report.figures.emplace_back(std::move(energy));
  return report;
}

}  // namespace isolux::bench
