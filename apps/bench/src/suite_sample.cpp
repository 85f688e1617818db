#include <fmt/format.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>
#include <cmath>

#include "resample_error.h"
#include "suites.h"

namespace isolux::bench {
namespace {

const std::vector<std::string> kScatterers{"random", "stratified", "low_discrepancy"};

struct Rates {
  Table table{.id = "rates",
              .title = "Fitted rates",
              .columns = {"scene", "sampler or tracer", "points", "error falls as", "+- (95 %)"}};
  void add(const std::string& scene, const Series& series, const std::string& what) {
    if (series.points.size() < 3) return;
    const PowerLaw law = fit_power_law(series.points);
    table.rows.push_back({scene, series.name, double(series.points.size()),
                          fmt::format("{}^{:.2f}", what, law.exponent), bar_text(law)});
  }
};

/// Error of the light at points against the number of sites, e exact at the sites.
Plot error_against_sites(const Truth& truth, const Volume& volume, const SuiteContext& context, double seconds,
                         Rates& rates) {
  Plot plot{.id = "sites-" + truth.name,
            .title = fmt::format("Error against sites: {}", truth.name),
            .x_label = "sites",
            .y_label = "rms error of e at points"};
  plot.sentence =
      "What scattering alone costs: e is exact at the sites, carried to the texels by Shepard's interpolation (k = 11, "
      "p = 2) and read at random points; bars are 95 % bootstrap intervals.";
  std::replace(plot.id.begin(), plot.id.end(), ' ', '-');
  const auto shepard = context.stages.resamplers.create("cell_grid", {{"k", "11"}, {"exponent", "2"}});
  const ProbePoints points = probe_points(truth, volume, std::size_t(context.pick(1000, 5000, 20000)), context);
  for (const std::string& sampler : kScatterers) plot.series.push_back({.name = sampler});
  Climb climb(seconds, 3.0);
  for (double count = 1e3; count <= context.pick(1e4, 1e5, 2e6) && climb.goes_on(); count *= std::sqrt(10.0)) {
    for (Series& series : plot.series) {
      const Sites sites = all_sites(volume, series.name, std::size_t(count), context);
      const SampleSet samples = exact_samples(truth, volume, sites, 0.0, context.run.seed);
      const Estimate error = resampling_error(points, volume, samples, *shepard, context).error;
      series.points.push_back({double(samples.size()), error.value, error.low, error.high});
    }
  }
  for (const Series& series : plot.series) rates.add(truth.name, series, "sites");
  return plot;
}

/// Error of e at the sites against the rays of each.
Plot error_against_rays(const Truth& truth, const Volume& volume, const SuiteContext& context, double seconds,
                        Rates& rates) {
  Plot plot{.id = "rays-" + truth.name,
            .title = fmt::format("Error against rays: {}", truth.name),
            .x_label = "rays a site",
            .y_label = "rms error of e at the sites"};
  plot.sentence =
      "What rays alone cost, at the sites themselves; a curve that stops falling has reached the distance between the "
      "sampled field and the analytic one; bars are 95 % bootstrap intervals.";
  std::replace(plot.id.begin(), plot.id.end(), ' ', '-');
  const auto sites = known_sites(truth, volume, "low_discrepancy", context.pick(200, 1000, 4000), context);
  std::vector<std::string> names;
  for (const BackendInfo& info : context.stages.tracers.backends()) {
    if (info.unavailable.empty()) names.push_back(info.name);
  }
  for (const std::string& name : names) {
    const auto tracer = context.stages.tracers.create(name);
    Series series{.name = name};
    Climb climb(seconds / double(names.size()), 4.0);
    for (int rays = 4; rays <= context.pick(64, 1024, 16384) && climb.goes_on(); rays *= 4) {
      const TraceResult traced =
          tracer->trace(volume, truth.scene, sites, {.rays = rays, .bounces = truth.bounces}, context.run);
      const Estimate error = rms_interval(errors_at_sites(truth, volume, traced.samples), context.run.seed);
      series.points.push_back({double(rays), error.value, error.low, error.high});
    }
    rates.add(truth.name, series, "rays");
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Table site_speed(const SuiteContext& context) {
  Table table{.id = "speed",
              .title = "Making sites",
              .columns = {"sampler", "sites", "ms", "million sites/s", "ms, a tenth of the isovalues"},
              .sentence =
                  "Median of three runs on gen:gyroid; the last column asks for the same number of sites within a "
                  "tenth of the isovalues."};
  const Volume volume = sample_analytic_field("gyroid", context.pick(17, 64, 192));
  const auto texels = cell_lattice(volume.lattice());
  for (const BackendInfo& info : context.stages.samplers.backends()) {
    const auto sampler = context.stages.samplers.create(info.name);
    std::size_t sites = 0;
    const auto seconds = [&](std::optional<ValueRange> range) {
      return timed(
                 [&] {
                   sites = sampler
                               ->sample(volume, {.texels = texels, .count = texels.count(), .isovalues = range},
                                        context.run)
                               .size();
                 },
                 3, 2.0)
          .value;
    };
    const double narrow = seconds(ValueRange{.low = 0.0f, .high = 0.3f});
    const double whole = seconds(std::nullopt);
    table.rows.push_back({info.name, double(sites), 1e3 * whole, 1e-6 * double(sites) / whole, 1e3 * narrow});
  }
  return table;
}

}  // namespace

SuiteReport run_sample(const SuiteContext& context) {
  SuiteReport report;
  Rates rates;
  rates.table.sentence =
      "Exponents by least squares in logarithms over all points of a curve, +- half their 95 % interval; chance alone "
      "gives -1/2 in rays, and an interpolant of first order -1/3 in sites.";
  const std::vector<Truth> truths{plane_under_ball(), plane_in_the_sun(), integrating_sphere()};
  std::size_t pieces = 6;  // five pictures, and the table of speeds
  for (const Truth& truth : truths) {
    context.say(truth.name);
    const Volume volume = sample_analytic_field(truth.field, context.pick(17, 41, 129));
    report.figures.emplace_back(error_against_sites(truth, volume, context, context.budget.share(pieces--), rates));
    if (truth.edge) continue;  // a sun's shadow has no chance in it: one ray tells
    report.figures.emplace_back(error_against_rays(truth, volume, context, context.budget.share(pieces--), rates));
  }
  for (const auto& row : rates.table.rows) {
    if (std::get<std::string>(row[0]) != truths.front().name) continue;
    report.highlights.push_back(fmt::format("{}, `{}`: the error falls as {} +- {}.", truths.front().name,
                                            std::get<std::string>(row[1]), std::get<std::string>(row[3]),
                                            std::get<std::string>(row[4])));
  }
  report.figures.emplace_back(std::move(rates.table));
  report.figures.emplace_back(site_speed(context));
  return report;
}

}  // namespace isolux::bench
