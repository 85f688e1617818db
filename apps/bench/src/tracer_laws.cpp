#include "tracer_laws.h"

#include <fmt/format.h>
#include <isolux/core/stopwatch.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "pockets.h"
#include "stats.h"
#include "stress_volumes.h"
#include "truths.h"

namespace isolux::bench {
namespace {

Scene furnace(float albedo, float emission) {
  Scene scene;
  scene.albedo = {{{0.0f, Vec3f(albedo)}}};
  scene.emission = {{{0.0f, Vec3f(emission)}}};
  return scene;
}

/// Everything a check of one tracer needs.
struct LawBench {
  const SuiteContext& context;
  std::string name;
  std::unique_ptr<FlatTracer> tracer;

  [[nodiscard]] Sites sites(const Volume& volume, std::size_t count, std::optional<ValueRange> range = {}) const {
    return context.stages.samplers.create("random")->sample(
        volume, {.texels = cell_lattice(volume.lattice()), .count = count, .isovalues = range}, context.run);
  }
  [[nodiscard]] TraceResult trace(const Volume& volume, const Scene& scene, Sites at, int rays, int bounces) const {
    return tracer->trace(volume, scene, std::move(at), {.rays = rays, .bounces = bounces}, context.run);
  }
};

LawBench bench_of(const std::string& tracer, const SuiteContext& context) {
  return {.context = context, .name = tracer, .tracer = context.stages.tracers.create(tracer)};
}

double mean_radiance(const SampleSet& samples) {
  double sum = 0.0;
  for (const float e : samples.radiance) sum += double(e);
  return sum / double(samples.radiance.size());
}

// .01 is far above the noise of the mean over all rays and half of what a tracer wrong by 2 % would show.
constexpr double kAllowedEnergy = 0.01;

const Volume& furnace_volume() {
  static const Volume volume = sample_analytic_field("gyroid", 33);
  return volume;
}

Sites furnace_sites(const LawBench& bench) {
  return bench.sites(furnace_volume(), std::size_t(bench.context.pick(100, 400, 4000)), open_gyroid());
}

void furnaces(const LawBench& bench, Judge& judge) {
  const Sites sites = furnace_sites(bench);
  const auto rays = 64.0 * double(sites.size());
  const auto energy = [&](float albedo, float emission) {
    return mean_radiance(bench.trace(furnace_volume(), furnace(albedo, emission), sites, 64, kAllBounces).samples);
  };
  judge.add({"white furnace, all bounces", bench.name, rays, "abs(mean e - 1)", std::fabs(energy(1.0f, 0.0f) - 1.0),
             kAllowedEnergy});
  judge.add({"emissive furnace, albedo .5", bench.name, rays, "abs(mean e - 1)", std::fabs(energy(0.5f, 0.5f) - 1.0),
             kAllowedEnergy});
}

/// How many of the sites get lighter where paths may be twenty times as long: light finds its way to them through necks
/// so narrow that the tracer's longest path ends before. None if the tracer has no such option.
double lit_by_longer_paths(const LawBench& bench, const Sites& sites, const std::vector<float>& before) {
  const BackendInfo& info = bench.context.stages.tracers.info(bench.name);
  const bool has_option = std::any_of(info.options.begin(), info.options.end(),
                                      [](const OptionInfo& option) { return option.name == "longest_path"; });
  if (!has_option || sites.size() == 0) return 0.0;
  const SampleSet longer =
      bench.context.stages.tracers.create(bench.name, {{"longest_path", "20000"}})
          ->trace(furnace_volume(), furnace(1.0f, 0.0f), sites, {.rays = 64, .bounces = kAllBounces}, bench.context.run)
          .samples;
  double lit = 0.0;
  for (std::size_t i = 0; i < longer.size(); ++i) lit += longer.radiance[i] > before[i] ? 1.0 : 0.0;
  return lit;
}

/// On all level sets, closed pockets included: whatever lacks light in the white furnace lies where a flood over the
/// volume finds no way out either, or behind a neck.
void pockets(const LawBench& bench, Judge& judge) {
  const Sites sites = bench.sites(furnace_volume(), std::size_t(bench.context.pick(150, 1000, 4000)));
  const SampleSet samples = bench.trace(furnace_volume(), furnace(1.0f, 0.0f), sites, 64, kAllBounces).samples;
  double dark = 0.0;
  std::vector<std::size_t> open;
  std::vector<float> light;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.radiance[i] > 1.0f - float(kAllowedEnergy)) continue;
    dark += 1.0;
    if (is_in_closed_pocket(furnace_volume(), Vec3(sites.positions[i]), sites.isovalues[i])) continue;
    open.push_back(i);
    light.push_back(samples.radiance[i]);
  }
  const auto outside = double(open.size());
  // More of them are the tracer's fault: nothing new is learned from hundreds.
  constexpr std::size_t kMostRetraced = 100;
  const double necks = open.size() > kMostRetraced ? 0.0 : lit_by_longer_paths(bench, some_of(sites, open), light);
  judge.add({"white furnace, every level set", bench.name, double(sites.size()),
             fmt::format("dark sites unexplained, of {:.0f} ({:.0f} in closed pockets, {:.0f} behind necks)", dark,
                         dark - outside, necks),
             outside - necks, 0.0});
}

/// The sharpest single test: a closed form in which every lost or gained ray counts many times over.
void open_sphere(const LawBench& bench, Judge& judge) {
  const Truth truth = integrating_sphere();
  const Volume volume = sample_analytic_field(truth.field, 65);
  const Sites sites =
      known_sites(truth, volume, "random", std::size_t(bench.context.pick(1000, 4000, 40000)), bench.context);
  double expected = 0.0;
  for (const Vec3f& p : sites.positions) expected += truth.light(volume.lattice().frame.world(Vec3(p)));
  expected /= double(sites.size());
  const double found = mean_radiance(bench.trace(volume, truth.scene, sites, 64, kAllBounces).samples);
  judge.add({"open integrating sphere, albedo .8", bench.name, 64.0 * double(sites.size()),
             "abs(mean e / closed form - 1)", std::fabs(found / expected - 1.0), kAllowedEnergy});
}

/// Noise in a shell of higher values: light has no way in, so any is a leak.
void leaks(const LawBench& bench, double seconds, Judge& judge) {
  const double wanted = bench.context.pick(1e5, 2e6, 1e8);
  double rays = 0.0;
  double leaked = 0.0;
  constexpr int kRays = 256;
  const Stopwatch watch;
  for (std::uint64_t seed = 1; rays < wanted && (seed == 1 || watch.seconds() < seconds); ++seed) {
    const Volume volume = closed_noise(24, seed);
    const Sites sites = bench.sites(volume, 400, ValueRange{.low = 0.0f, .high = 0.999f});
    const SampleSet samples = bench.trace(volume, Scene{}, sites, kRays, 0).samples;
    rays += kRays * double(sites.size());
    for (const float e : samples.radiance) leaked += double(e) * kRays;
  }
  judge.add({"closed level sets of noise volumes", bench.name, rays, "rays that leaked", std::round(leaked), 0.0});
}

/// Values that a number may go wrong on: each volume's outputs have to be finite and not negative.
void numbers(const LawBench& bench, Judge& judge) {
  double bad = 0.0;
  double total = 0.0;
  for (const Volume& volume : nasty_volumes()) {
    const SampleSet samples =
        bench.trace(volume, Scene{}, bench.sites(volume, bench.context.pick(100, 500, 5000)), 32, kAllBounces).samples;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      total += 1.0;
      const bool fine = std::isfinite(samples.radiance[i]) && samples.radiance[i] >= 0.0f &&
                        std::isfinite(samples.variance[i]) && samples.variance[i] >= 0.0f;
      bad += fine ? 0.0 : 1.0;
    }
  }
  judge.add({"huge, tiny, flat, stretched and distant volumes", bench.name, total, "outputs not finite or negative",
             bad, 0.0});
}

/// Twice the light is twice e, to the bit: the random numbers are the same and 2 is a power of two.
void linearity(const LawBench& bench, Judge& judge) {
  const Volume volume = sample_analytic_field("marschner-lobb", 41);
  const Sites sites = bench.sites(volume, std::size_t(bench.context.pick(100, 500, 5000)));
  Scene twice;
  twice.environment = UniformEnvironment{Vec3f(2.0f)};
  const SampleSet once = bench.trace(volume, Scene{}, sites, 32, kAllBounces).samples;
  const SampleSet doubled = bench.trace(volume, twice, sites, 32, kAllBounces).samples;
  double worst = 0.0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    worst = std::max(worst, std::fabs(double(doubled.radiance[i]) - 2.0 * double(once.radiance[i])));
  }
  judge.add({"linearity in the sources", bench.name, double(once.size()), "largest abs(e(2 L) - 2 e(L))", worst, 2e-6});
}

/// The tracer against the double-precision one: equal up to the noise of both.
void against_double(const LawBench& bench, Judge& judge) {
  if (bench.name == "scalar") return;
  const auto scalar = bench.context.stages.tracers.create("scalar");
  double worst = 0.0;
  double sites_seen = 0.0;
  for (const char* field : {"gyroid", "marschner-lobb", "noise"}) {
    const Volume volume = sample_analytic_field(field, 33);
    const Sites sites = bench.sites(volume, std::size_t(bench.context.pick(500, 2000, 20000)));
    const SampleSet fast = bench.trace(volume, Scene{}, sites, 64, 0).samples;
    const SampleSet exact =
        scalar->trace(volume, Scene{}, sites, {.rays = 64, .bounces = 0}, bench.context.run).samples;
    double variance = 0.0;
    for (std::size_t i = 0; i < sites.size(); ++i) variance += double(fast.variance[i]) + double(exact.variance[i]);
    const double deviation = std::sqrt(variance) / double(sites.size());
    worst = std::max(worst, std::fabs(mean_radiance(fast) - mean_radiance(exact)) / std::max(deviation, 1e-9));
    sites_seen += double(sites.size());
  }
  judge.add({"float against double, three fields", bench.name, sites_seen, "difference of mean e in standard errors",
             worst, 5.0});
}

/// What skipping is worth, in numbers that no busy machine can blur.
void work(const LawBench& bench, Judge& judge) {
  const Volume volume = sample_analytic_field("gyroid", 97);
  // Few isovalues: tracers that look at intervals of them see no more than the sites need.
  const Sites sites = bench.sites(volume, bench.context.pick(500, 2000, 20000), ValueRange{.low = 0.0f, .high = 0.01f});
  const TraceCounters counters = bench.trace(volume, Scene{}, sites, 64, 0).counters;
  // A ray crosses some 30 cells of this volume before it hits or leaves, and fewer than 10 of them reach its isovalue:
  // between the two is whoever skips some and forgets others.
  judge.add({"work in gen:gyroid:97", bench.name, double(counters.rays), "cells tested a ray",
             double(counters.cells) / double(counters.rays), 14.0});
}

}  // namespace

void try_laws(const std::string& tracer, const SuiteContext& context, double seconds, Judge& judge) {
  const LawBench bench = bench_of(tracer, context);
  furnaces(bench, judge);
  pockets(bench, judge);
  open_sphere(bench, judge);
  leaks(bench, seconds, judge);
  numbers(bench, judge);
  linearity(bench, judge);
  against_double(bench, judge);
  work(bench, judge);
}

Series furnace_energy(const std::string& tracer, const SuiteContext& context) {
  const LawBench bench = bench_of(tracer, context);
  const Sites sites = furnace_sites(bench);
  Series energy{.name = tracer};
  for (const int bounces : {0, 1, 2, 4, 8, 16, 32}) {
    const SampleSet samples = bench.trace(furnace_volume(), furnace(1.0f, 0.0f), sites, 64, bounces).samples;
    double variance = 0.0;
    for (const float v : samples.variance) variance += double(v);
    const double e = mean_radiance(samples);
    const double bar = 1.96 * std::sqrt(variance) / double(samples.size());
    energy.points.push_back({double(bounces), e, e - bar, e + bar});
  }
  return energy;
}

}  // namespace isolux::bench
