#include <fmt/format.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>

#include "resample_error.h"
#include "suites.h"

namespace isolux::bench {
namespace {

/// A resampler with settings, as a curve of the plots: its points are the numbers of neighbours.
struct Resampling {
  std::string name;
  std::string backend;
  Settings settings;
  std::vector<int> neighbours;  ///< values of the option k; empty if it has none
  bool is_typical = false;      ///< also measured at other kinds and numbers of sites, with its middle k
};

bool has_option(const BackendInfo& info, std::string_view name) {
  return std::any_of(info.options.begin(), info.options.end(), [&](const OptionInfo& o) { return o.name == name; });
}

/// Every backend that takes scattered samples. The Shepard family, whose backends agree to rounding, is varied for one
/// of them and timed for the others.
std::vector<Resampling> methods(const SuiteContext& context) {
  const std::vector<int> ks = context.pick<std::vector<int>>({11}, {4, 11, 32}, {1, 4, 11, 16, 32, 64});
  std::vector<Resampling> list;
  for (const BackendInfo& info : context.stages.resamplers.backends()) {
    if (!info.unavailable.empty() || info.name == "direct") continue;
    if (info.name == "cell_grid") {
      for (const char* p : {"0.5", "2", "4"}) {
        list.push_back({fmt::format("Shepard, p = {}", p), info.name, {{"exponent", p}}, ks, std::string(p) != "4"});
      }
      for (const char* metric : {"city_block", "chebyshev"}) {
        list.push_back(
            {fmt::format("Shepard, p = 2, {}", metric), info.name, {{"exponent", "2"}, {"distance", metric}}, {11}});
      }
    } else if (has_option(info, "exponent")) {
      list.push_back({fmt::format("{}, p = 2", info.name), info.name, {{"exponent", "2"}}, {11}});
    } else {
      list.push_back({info.name, info.name, {}, has_option(info, "k") ? ks : std::vector<int>{}, true});
    }
  }
  return list;
}

struct Case {
  Truth truth;
  double noise;
  std::string id;
  std::string title;
};

std::vector<Case> cases() {
  return {{plane_under_ball(), 0.0, "smooth", "smooth light"},
          {plane_under_ball(), 0.1, "noisy", "smooth light, noise .1 in the samples"},
          {plane_in_the_sun(), 0.0, "shadow", "shadow edges"},
          {plane_in_the_sun(), 0.1, "noisy-shadow", "shadow edges, noise .1 in the samples"},
          {integrating_sphere(), 0.0, "sphere", "integrating sphere"}};
}

/// A case with its volume and the points where it is judged.
struct ResamplingBench {
  const SuiteContext& context;
  const Case& test;
  Volume volume;
  ProbePoints points;

  [[nodiscard]] SampleSet samples(const std::string& sampler, std::size_t count) const {
    return exact_samples(test.truth, volume, all_sites(volume, sampler, count, context), test.noise, context.run.seed);
  }
  [[nodiscard]] ResamplingResult error(const Resampling& method, int k, const SampleSet& samples) const {
    Settings settings = method.settings;
    if (k > 0) settings["k"] = std::to_string(k);
    return resampling_error(points, volume, samples, *context.stages.resamplers.create(method.backend, settings),
                            context);
  }
};

Cell none_if_zero(double value) { return value > 0.0 ? Cell(value) : Cell(kNone); }

/// Adds one method's row to the table and point to its curve.
void measure(const ResamplingBench& bench, const Resampling& method, const std::string& sampler,
             const SampleSet& samples, const std::vector<int>& ks, Table& table, Series& series) {
  for (const int k : ks) {
    const ResamplingResult result = bench.error(method, k, samples);
    table.rows.push_back({bench.test.title, sampler, method.name, k > 0 ? Cell(double(k)) : Cell(std::string()),
                          double(samples.size()), 1e3 * result.seconds.value, result.error.value, result.error.low,
                          result.error.high, none_if_zero(result.smooth.value), none_if_zero(result.edge.value)});
    series.points.push_back({1e3 * result.seconds.value, result.error.value, result.error.low, result.error.high,
                             1e3 * result.seconds.low, 1e3 * result.seconds.high});
  }
}

/// The one k of a method that stands for it: a plane is fitted to more samples than a mean is taken of.
int typical_k(const Resampling& method) {
  if (method.neighbours.empty()) return 0;
  return method.backend == "moving_least_squares" && method.neighbours.size() > 3 ? 16 : 11;
}

Plot error_over_time(const ResamplingBench& bench, std::size_t wanted, Table& table) {
  const Case& test = bench.test;
  Plot plot{.id = test.id,
            .title = fmt::format("Resampling: {}", test.title),
            .x_label = "ms",
            .y_label = "rms error of e at points"};
  plot.sentence = fmt::format(
      "About {} low-discrepancy sites with exact e{}, carried to {}^3 texels and read at random points; along a curve "
      "the number of neighbours grows; bars are 95 % bootstrap intervals and quartiles of the time.",
      number_text(double(wanted)), test.noise > 0.0 ? " plus noise" : "", bench.volume.lattice().size.x - 1);
  for (const std::string sampler : {"low_discrepancy", "random", "stratified"}) {
    const SampleSet samples = bench.samples(sampler, wanted);
    const bool is_plotted = sampler == "low_discrepancy";
    for (const Resampling& method : methods(bench.context)) {
      // Backends of one method agree to rounding: one of them is enough beside the first case.
      const bool same_method = method.backend == "brute_force" || method.backend == "cgal_kdtree";
      if (same_method && test.id != "smooth") continue;
      if (!is_plotted && !method.is_typical) continue;
      std::vector<int> ks{typical_k(method)};
      if (is_plotted && !method.neighbours.empty()) ks = method.neighbours;
      Series series{.name = method.name};
      measure(bench, method, sampler, samples, ks, table, series);
      if (is_plotted) plot.series.push_back(std::move(series));
    }
  }
  return plot;
}

Plot error_over_samples(const ResamplingBench& bench, double seconds, Table& rates) {
  const Case& test = bench.test;
  Plot plot{.id = "samples-" + test.id,
            .title = fmt::format("Error against samples: {}", test.title),
            .x_label = "samples",
            .y_label = "rms error of e at points"};
  plot.sentence = "Low-discrepancy sites; a curve that stops falling has reached what texels a cell apart can say.";
  std::vector<Resampling> typical = methods(bench.context);
  std::erase_if(typical, [](const Resampling& m) { return !m.is_typical; });
  for (const Resampling& method : typical) plot.series.push_back({.name = method.name});
  Climb climb(seconds, 2.0);
  for (std::size_t count = 1000; count <= bench.context.pick(4000u, 32000u, 512000u) && climb.goes_on(); count *= 2) {
    const SampleSet samples = bench.samples("low_discrepancy", count);
    for (std::size_t m = 0; m < typical.size(); ++m) {
      const Estimate error = bench.error(typical[m], typical_k(typical[m]), samples).error;
      plot.series[m].points.push_back({double(samples.size()), error.value, error.low, error.high});
    }
  }
  for (const Series& series : plot.series) {
    if (series.points.size() < 3) continue;
    const PowerLaw law = fit_power_law(series.points);
    rates.rows.push_back({test.title, series.name, double(series.points.size()),
                          fmt::format("samples^{:.2f}", law.exponent), bar_text(law)});
  }
  return plot;
}

/// The most accurate method of a picture, and where the thesis's weights stand.
std::string most_accurate(const Plot& plot, const std::string& title) {
  const auto least = [](const Series& s) {
    return *std::min_element(s.points.begin(), s.points.end(),
                             [](const PlotPoint& a, const PlotPoint& b) { return a.y < b.y; });
  };
  const auto best = std::min_element(plot.series.begin(), plot.series.end(),
                                     [&](const Series& a, const Series& b) { return least(a).y < least(b).y; });
  const auto thesis = std::find_if(plot.series.begin(), plot.series.end(),
                                   [](const Series& s) { return s.name == "Shepard, p = 0.5"; });
  return fmt::format(
      "{}: `{}` is the most accurate, rms {} in {} ms; Shepard's weights with p = .5 come to {} in {} ms.", title,
      best->name, number_text(least(*best).y), number_text(least(*best).x), number_text(least(*thesis).y),
      number_text(least(*thesis).x));
}

}  // namespace

SuiteReport run_resample(const SuiteContext& context) {
  SuiteReport report;
  Table table{.id = "all",
              .title = "Every resampler, sampler and case",
              .columns = {"case", "sites by", "method", "k", "samples", "ms", "rms error", "95 % from", "to",
                          "rms away from edges", "rms near edges"}};
  table.sentence =
      "The figures behind the pictures, for all three ways of scattering sites; the last column is of points within "
      "one and a half cells of a shadow's edge.";
  Table rates{
      .id = "rates", .title = "Fitted rates", .columns = {"case", "method", "points", "error falls as", "+- (95 %)"}};
  rates.sentence =
      "Least squares in logarithms over all points of a curve; +- is half the 95 % interval of the exponent.";
  const int n = context.pick(13, 25, 65);
  const auto wanted = std::size_t(context.pick(500, 4000, 100000));
  const std::vector<Case> all = cases();
  std::vector<Plot> plots;
  for (std::size_t c = 0; c < all.size(); ++c) {
    const Case& test = all[c];
    context.say(test.title);
    ResamplingBench bench{
        .context = context, .test = test, .volume = sample_analytic_field(test.truth.field, n), .points = {}};
    bench.points = probe_points(test.truth, bench.volume, std::size_t(context.pick(2000, 8000, 20000)), context);
    Plot plot = error_over_time(bench, wanted, table);
    report.highlights.push_back(most_accurate(plot, test.title));
    report.figures.emplace_back(std::move(plot));
    plots.push_back(error_over_samples(bench, context.budget.share(2 * (all.size() - c)), rates));
  }
  for (Plot& plot : plots) report.figures.emplace_back(std::move(plot));
  report.figures.emplace_back(std::move(rates));
  report.figures.emplace_back(std::move(table));
  return report;
}

}  // namespace isolux::bench
