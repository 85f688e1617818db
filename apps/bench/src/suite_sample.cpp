#include <fmt/format.h>
#include <isolux/core/stopwatch.h>
#include <isolux/volume_io/analytic_fields.h>

#include <cmath>

#include "resample_error.h"
#include "suites.h"

namespace isolux::bench {
namespace {

const std::vector<std::string> kScatterers{"random", "stratified", "low_discrepancy"};

struct Rates {
  Table table{.id = "rates",
              .title = "Fitted rates",
              .columns = {"scene", "sampler", "of", "error falls as", "standard error of the exponent"},
              .sentence =
                  "Exponents by least squares in logarithms over all points of a curve; chance alone gives -1/2 in "
                  "rays, and an interpolant of first order -1/3 in sites."};
  void add(const std::string& scene, const std::string& sampler, const std::string& what,
           const std::vector<PlotPoint>& points) {
    std::vector<double> x;
    std::vector<double> y;
    for (const PlotPoint& p : points) {
      x.push_back(p.x);
      y.push_back(p.y);
    }
    if (x.size() < 3) return;
    const PowerLaw law = fit_power_law(x, y);
    table.rows.push_back({scene, sampler, what, fmt::format("{}^{:.2f}", what, law.exponent),
                          fmt::format("{:.2f}", law.exponent_error)});
  }
};

/// Error of the light at texels against the number of sites, e exact at the sites.
Plot error_against_sites(const Truth& truth, const Volume& volume, const SuiteContext& context, Rates& rates) {
  Plot plot{.id = "sites-" + truth.field,
            .title = fmt::format("Error against sites: {}", truth.name),
            .x_label = "sites",
            .y_label = "rms error of e at texels"};
  plot.sentence =
      "What scattering alone costs: e is exact at the sites and carried to the texels by Shepard's interpolation (k = "
      "11, "
      "p = 2); bars are 95 % bootstrap intervals over texels.";
  const std::vector<double> counts =
      context.full ? std::vector<double>{1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6} : std::vector<double>{1e3, 3e3, 1e4, 3e4};
  const auto shepard = context.stages.resamplers.create("cell_grid", {{"k", "11"}, {"exponent", "2"}});
  for (const std::string& sampler : kScatterers) {
    Series series{.name = sampler, .points = {}};
    for (const double count : counts) {
      const Sites sites = all_sites(volume, sampler, std::size_t(count), context);
      const SampleSet samples = exact_samples(truth, volume, sites, 0.0, context.run.seed);
      const Estimate error = resampling_error(truth, volume, samples, *shepard, context).error;
      series.points.push_back({double(samples.size()), error.value, error.low, error.high});
    }
    rates.add(truth.name, sampler, "sites", series.points);
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// Error of e at the sites against the rays of each.
Plot error_against_rays(const Truth& truth, const Volume& volume, const SuiteContext& context, Rates& rates) {
  Plot plot{.id = "rays-" + truth.field,
            .title = fmt::format("Error against rays: {}", truth.name),
            .x_label = "rays a site",
            .y_label = "rms error of e at the sites"};
  plot.sentence =
      "What rays alone cost, at the sites themselves; a curve that stops falling has reached the distance between the "
      "sampled field and the analytic one.";
  const auto sites = known_sites(truth, volume, "low_discrepancy", context.pick(1000, 8000), context);
  for (const BackendInfo& info : context.stages.tracers.backends()) {
    if (!info.unavailable.empty()) continue;
    const auto tracer = context.stages.tracers.create(info.name);
    Series series{.name = info.name, .points = {}};
    std::vector<PlotPoint> falling;
    for (int rays = 4; rays <= context.pick(256, 4096); rays *= 4) {
      const TraceResult traced =
          tracer->trace(volume, truth.scene, sites, {.rays = rays, .bounces = truth.bounces}, context.run);
      const auto errors = errors_at_sites(truth, volume, traced.samples);
      const Estimate error = rms_interval(errors, context.run.seed);
      series.points.push_back({double(rays), error.value, error.low, error.high});
    }
    rates.add(truth.name, info.name, "rays", series.points);
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
  const Volume volume = sample_analytic_field("gyroid", context.pick(64, 256));
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
                 3, 20.0)
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
  for (const Truth& truth : {plane_under_ball(), plane_in_the_sun(), integrating_sphere()}) {
    context.say(truth.name);
    const Volume volume = sample_analytic_field(truth.field, context.pick(41, 129));
    report.figures.emplace_back(error_against_sites(truth, volume, context, rates));
    if (truth.name != plane_in_the_sun().name) {
      report.figures.emplace_back(error_against_rays(truth, volume, context, rates));
    }
  }
  report.figures.emplace_back(std::move(rates.table));
  report.figures.emplace_back(site_speed(context));
  return report;
}

}  // namespace isolux::bench
