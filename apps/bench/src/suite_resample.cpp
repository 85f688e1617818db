#include <fmt/format.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>

#include "resample_error.h"
#include "suites.h"

namespace isolux::bench {
namespace {

/// A resampler with settings, as a curve of the plots: its points are the numbers of neighbours.
struct Method {
  std::string name;
  std::string backend;
  Settings settings;
  std::vector<int> neighbours;  ///< values of the option k; empty if it has none
};

bool has_option(const BackendInfo& info, std::string_view name) {
  return std::any_of(info.options.begin(), info.options.end(), [&](const OptionInfo& o) { return o.name == name; });
}

/// Every backend that takes scattered samples. The Shepard family, whose backends agree to rounding, is varied for one
/// of them and timed for the others.
std::vector<Method> methods(const SuiteContext& context) {
  const std::vector<int> ks = context.full ? std::vector<int>{1, 4, 11, 16, 32, 64} : std::vector<int>{4, 11, 32};
  std::vector<Method> list;
  for (const BackendInfo& info : context.stages.resamplers.backends()) {
    if (!info.unavailable.empty() || info.name == "direct") continue;
    if (info.name == "cell_grid") {
      for (const char* p : {"0.5", "2", "4"}) {
        list.push_back({fmt::format("Shepard, p = {}", p), info.name, {{"exponent", p}}, ks});
      }
      for (const char* metric : {"city_block", "chebyshev"}) {
        list.push_back(
            {fmt::format("Shepard, p = 2, {}", metric), info.name, {{"exponent", "2"}, {"distance", metric}}, {11}});
      }
    } else if (has_option(info, "exponent")) {
      list.push_back({fmt::format("{}, p = 2", info.name), info.name, {{"exponent", "2"}}, {11}});
    } else {
      list.push_back({info.name, info.name, {}, has_option(info, "k") ? ks : std::vector<int>{}});
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

/// Adds one method's row to the table and point to its curve.
void measure(const Case& test, const Method& method, const std::string& sampler, const Volume& volume,
             const SampleSet& samples, const SuiteContext& context, Table& table, Series& series) {
  std::vector<int> ks = method.neighbours;
  if (ks.empty()) ks.push_back(0);
  for (const int k : ks) {
    Settings settings = method.settings;
    if (k > 0) settings["k"] = std::to_string(k);
    const auto resampler = context.stages.resamplers.create(method.backend, settings);
    const ResamplingResult result = resampling_error(test.truth, volume, samples, *resampler, context);
    table.rows.push_back({test.title, sampler, method.name, k > 0 ? Cell(double(k)) : Cell(std::string()),
                          double(samples.size()), 1e3 * result.seconds, result.error.value, result.error.low,
                          result.error.high});
    series.points.push_back({1e3 * result.seconds, result.error.value, result.error.low, result.error.high});
  }
}

}  // namespace

SuiteReport run_resample(const SuiteContext& context) {
  SuiteReport report;
  Table table{.id = "all",
              .title = "Every resampler, sampler and case",
              .columns = {"case", "sites by", "method", "k", "samples", "ms", "rms error", "95 % from", "to"},
              .sentence =
                  "The figures behind the pictures, for all three ways of scattering sites; times are of one run "
                  "to every texel of the volume, errors over the texels whose exact e is known."};
  const std::vector<Case> cases{
      {plane_under_ball(), 0.0, "smooth", "smooth light"},
      {plane_under_ball(), 0.1, "noisy", "smooth light, noise .1 in the samples"},
      {plane_in_the_sun(), 0.0, "shadow", "shadow edges"},
      {integrating_sphere(), 0.0, "sphere", "integrating sphere"},
  };
  const int n = context.pick(25, 97);
  for (const Case& test : cases) {
    context.say(test.title);
    const Volume volume = sample_analytic_field(test.truth.field, n);
    Plot plot{.id = test.id,
              .title = fmt::format("Resampling: {}", test.title),
              .x_label = "ms",
              .y_label = "rms error of e at texels"};
    plot.sentence = fmt::format(
        "About {} low-discrepancy sites with exact e{}, carried to {}^3 texels; along a curve the number of neighbours "
        "grows, bars are 95 % bootstrap intervals.",
        number_text(context.pick(4000.0, 200000.0)), test.noise > 0.0 ? " plus noise" : "", n - 1);
    for (const std::string sampler : {"random", "stratified", "low_discrepancy"}) {
      const auto wanted = std::size_t(context.pick(4000, 200000));
      const SampleSet samples =
          exact_samples(test.truth, volume, all_sites(volume, sampler, wanted, context), test.noise, context.run.seed);
      for (const Method& method : methods(context)) {
        // Backends of one method agree to rounding: one of them is enough beside the first case.
        const bool same_method = method.backend == "brute_force" || method.backend == "cgal_kdtree";
        if (same_method && (sampler != "low_discrepancy" || test.id != "smooth")) continue;
        Series series{.name = method.name, .points = {}};
        measure(test, method, sampler, volume, samples, context, table, series);
        if (sampler == "low_discrepancy") plot.series.push_back(std::move(series));
      }
    }
    report.figures.emplace_back(std::move(plot));
  }
  report.figures.emplace_back(std::move(table));
  return report;
}

}  // namespace isolux::bench
