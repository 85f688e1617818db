#include <fmt/format.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/raytrace_flat/level_set_intersector.h>
#include <isolux/volume_io/analytic_fields.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "stats.h"
#include "stress_volumes.h"
#include "suites.h"

namespace isolux::bench {
namespace {

/// The rows of the one table, and what failed.
class Judge {
 public:
  void row(const std::string& what, const std::string& tracer, double cases, const std::string& figure, double worst,
           double limit) {
    const bool passes = worst <= limit;  // false for NaN
    table_.rows.push_back({what, tracer, cases, figure, worst, limit, std::string(passes ? "pass" : "**FAIL**")});
    if (!passes)
      failures_.push_back(fmt::format("{} ({}): {} is {:.3g}, allowed is {:.3g}", what, tracer, figure, worst, limit));
  }
  void give(SuiteReport& report) {
    report.figures.emplace_back(std::move(table_));
    report.failures = std::move(failures_);
  }

 private:
  Table table_{.id = "all",
               .title = "Stress cases",
               .columns = {"case", "tracer", "cases", "figure", "worst", "allowed", ""},
               .sentence = "Each row is a law that has to hold however the volume looks, with the worst figure found."};
  std::vector<std::string> failures_;
};

Scene furnace(float albedo, float emission) {
  Scene scene;
  scene.albedo = {{{0.0f, Vec3f(albedo)}}};
  scene.emission = {{{0.0f, Vec3f(emission)}}};
  return scene;
}

/// Everything a check of one tracer needs.
struct Bench {
  const SuiteContext& context;
  std::string name;
  std::unique_ptr<FlatTracer> tracer;

  [[nodiscard]] Sites sites(const Volume& volume, std::size_t count, std::optional<ValueRange> range = {}) const {
    return context.stages.samplers.create("random")->sample(
        volume, {.texels = cell_lattice(volume.lattice()), .count = count, .isovalues = range}, context.run);
  }
  [[nodiscard]] SampleSet trace(const Volume& volume, const Scene& scene, Sites at, int rays, int bounces) const {
    return tracer->trace(volume, scene, std::move(at), {.rays = rays, .bounces = bounces}, context.run).samples;
  }
};

double mean_radiance(const SampleSet& samples) {
  double sum = 0.0;
  for (const float e : samples.radiance) sum += double(e);
  return sum / double(samples.radiance.size());
}

/// Energy in the white furnace: the plot of its rise over bounces, and the rows of its end and of the emissive one.
Series furnaces(const Bench& bench, Judge& judge) {
  const Volume volume = sample_analytic_field("gyroid", 33);
  // Above -1.2 the side of lower values is one piece, open to the box's faces from everywhere; below it falls apart
  // into pockets that stay dark.
  const Sites sites =
      bench.sites(volume, std::size_t(bench.context.pick(400, 4000)), ValueRange{.low = -1.2f, .high = 1.6f});
  Series energy{.name = bench.name, .points = {}};
  for (const int bounces : {0, 1, 2, 4, 8, 16}) {
    energy.points.push_back(
        {double(bounces), mean_radiance(bench.trace(volume, furnace(1.0f, 0.0f), sites, 64, bounces))});
  }
  const double white = mean_radiance(bench.trace(volume, furnace(1.0f, 0.0f), sites, 64, kAllBounces));
  const double glowing = mean_radiance(bench.trace(volume, furnace(0.5f, 0.5f), sites, 64, kAllBounces));
  // .01 is far above the noise of the mean over all rays and half of what a tracer wrong by 2 % would show.
  constexpr double kAllowed = 0.01;
  const auto rays = 64.0 * double(sites.size());
  judge.row("white furnace, all bounces", bench.name, rays, "abs(mean e - 1)", std::fabs(white - 1.0), kAllowed);
  judge.row("emissive furnace, albedo .5", bench.name, rays, "abs(mean e - 1)", std::fabs(glowing - 1.0), kAllowed);
  // The check of the check: the same light, wrong by 2 %, has to be seen.
  judge.row("white furnace notices light wrong by 2 %", bench.name, rays, "allowed / abs(1.02 mean e - 1)",
            kAllowed / std::fabs(1.02 * white - 1.0), 1.0);
  return energy;
}

/// Noise in a shell of higher values: light has no way in, so any is a leak.
void leaks(const Bench& bench, Judge& judge) {
  const auto wanted = bench.context.pick(2e6, 1e8);
  double rays = 0.0;
  double leaked = 0.0;
  constexpr int kRays = 256;
  for (std::uint64_t seed = 1; rays < wanted; ++seed) {
    const Volume volume = closed_noise(24, seed);
    const Sites sites = bench.sites(volume, 4000, ValueRange{.low = 0.0f, .high = 0.999f});
    const SampleSet samples = bench.trace(volume, Scene{}, sites, kRays, 0);
    rays += kRays * double(sites.size());
    for (const float e : samples.radiance) leaked += double(e) * kRays;
  }
  judge.row("closed level sets of noise volumes", bench.name, rays, "rays that leaked", std::round(leaked), 0.0);
}

/// Values that a number may go wrong on: each volume's outputs have to be finite and not negative.
void numbers(const Bench& bench, Judge& judge) {
  double bad = 0.0;
  double total = 0.0;
  for (const Volume& volume : nasty_volumes()) {
    const SampleSet samples = bench.trace(volume, Scene{}, bench.sites(volume, 500), 32, kAllBounces);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      total += 1.0;
      const bool fine = std::isfinite(samples.radiance[i]) && samples.radiance[i] >= 0.0f &&
                        std::isfinite(samples.variance[i]) && samples.variance[i] >= 0.0f;
      bad += fine ? 0.0 : 1.0;
    }
  }
  judge.row("huge, tiny, flat, stretched and distant volumes", bench.name, total, "outputs not finite or negative", bad,
            0.0);
}

/// Twice the light is twice e, to the bit: the random numbers are the same and 2 is a power of two.
void linearity(const Bench& bench, Judge& judge) {
  const Volume volume = sample_analytic_field("marschner-lobb", 41);
  const Sites sites = bench.sites(volume, 500);
  Scene twice;
  twice.environment = UniformEnvironment{Vec3f(2.0f)};
  const SampleSet once = bench.trace(volume, Scene{}, sites, 32, kAllBounces);
  const SampleSet doubled = bench.trace(volume, twice, sites, 32, kAllBounces);
  double worst = 0.0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    worst = std::max(worst, std::fabs(double(doubled.radiance[i]) - 2.0 * double(once.radiance[i])));
  }
  judge.row("linearity in the sources", bench.name, double(once.size()), "largest abs(e(2 L) - 2 e(L))", worst, 2e-6);
}

/// The tracer against the double-precision one: equal up to the noise of both.
void against_double(const Bench& bench, Judge& judge) {
  if (bench.name == "scalar") return;
  const auto scalar = bench.context.stages.tracers.create("scalar");
  double worst = 0.0;
  double sites_seen = 0.0;
  for (const char* field : {"gyroid", "marschner-lobb", "noise"}) {
    const Volume volume = sample_analytic_field(field, 33);
    const Sites sites = bench.sites(volume, std::size_t(bench.context.pick(2000, 20000)));
    const SampleSet fast = bench.trace(volume, Scene{}, sites, 64, 0);
    const SampleSet exact =
        scalar->trace(volume, Scene{}, sites, {.rays = 64, .bounces = 0}, bench.context.run).samples;
    double variance = 0.0;
    for (std::size_t i = 0; i < sites.size(); ++i) variance += double(fast.variance[i]) + double(exact.variance[i]);
    const double deviation = std::sqrt(variance) / double(sites.size());
    worst = std::max(worst, std::fabs(mean_radiance(fast) - mean_radiance(exact)) / std::max(deviation, 1e-9));
    sites_seen += double(sites.size());
  }
  judge.row("float against double, three fields", bench.name, sites_seen, "difference of mean e in standard errors",
            worst, 5.0);
}

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
      pair.volume, {.texels = cell_lattice(pair.volume.lattice()), .count = std::size_t(context.pick(20000, 400000))},
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
  judge.row(what, "intersector", rays, "largest change of t, cells", worst, 1e-4);
  // Where a root is double to rounding, either answer is right: rays that graze, some in a million.
  judge.row(what, "intersector", rays, "hits that changed, per million", 1e6 * disagreements / rays, 100.0);
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
    judge.row("constant light", info.name, double(result.lit.size()), "largest change", worst, 1e-6);
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
  energy.sentence = "Albedo 1 under uniform light: every bounce brings e nearer to 1 and none past it.";
  for (const BackendInfo& info : context.stages.tracers.backends()) {
    if (!info.unavailable.empty()) continue;
    context.say(info.name);
    const Bench bench{.context = context, .name = info.name, .tracer = context.stages.tracers.create(info.name)};
    energy.series.push_back(furnaces(bench, judge));
    leaks(bench, judge);
    numbers(bench, judge);
    linearity(bench, judge);
    against_double(bench, judge);
  }
  context.say("invariance");
  for (const auto& [what, pair] : transformations(context.run)) invariance(context, judge, what, pair);
  constants(context, judge);
  judge.give(report);
  report.figures.emplace_back(std::move(energy));
  return report;
}

}  // namespace isolux::bench
