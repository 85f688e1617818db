// Rounds of rays towards an error or a time.
#include <isolux/bake/kept_rays.h>
#include <isolux/core/stopwatch.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "bake_parts.h"
#include "ray_budget.h"
#include "reading_error.h"
#include "standard_error.h"
#include "texel_rounds.h"

namespace isolux {
namespace {

/// Rounds of doubling: more than the 2^20 rays that a site may have need.
constexpr int kMostRounds = 24;

/// Those whose rays say anything: that have a normal.
std::vector<std::uint32_t> all_that_are_lit(std::span<const float> variances) {
  std::vector<std::uint32_t> sites;
  for (std::size_t i = 0; i < variances.size(); ++i)
    if (variances[i] < kUnknownVariance) sites.push_back(std::uint32_t(i));
  return sites;
}

double squared(double x) { return x * x; }

/// The sites of links as those of their samples, until it ends.
class LentSites {
 public:
  LentSites(LightLinks& links, SampleSet& samples) : links_(links), samples_(samples) {
    samples_.sites = links_.take_sites();
  }
  LentSites(const LentSites&) = delete;
  LentSites& operator=(const LentSites&) = delete;
  ~LentSites() { links_.give_back(std::move(samples_.sites)); }

 private:
  LightLinks& links_;
  SampleSet& samples_;
};

}  // namespace

bool KeptRays::has_begun() const {
  const auto traced = links_->rays();
  return *std::max_element(traced.begin(), traced.end()) >= std::uint32_t(kFirstRays);
}

double KeptRays::reading_error(const SampleSet& samples) const { return judge_ == nullptr ? 0.0 : judge_->of(samples); }

double KeptRays::noise_worth_rays(SampleSet& samples, const Run& run, BakeResult& result) {
  if (!(settings_.target_rmse > 0.0) || !has_begun()) return 0.0;
  if (texel_rounds_ == nullptr || !texel_rounds_->judge.can_judge())
    return squared_noise_for(settings_.target_rmse, reading_error(samples));
  TexelRounds& rounds = *texel_rounds_;
  const double noise = squared(standard_error(samples.variance));
  if (noise > rounds.wanted) return rounds.wanted;
  {
    const LentSites lent(*links_, samples);
    make_light(volume_, samples, *resampler_, texels_, settings_, run, result);
  }
  const Stopwatch watch;
  rounds.error = rounds.judge.squared_error(result.light, run);
  rounds.is_lit = true;
  judge_seconds_ += watch.seconds();
  rounds.target.add(noise, *rounds.error);
  rounds.wanted = rounds.target.wanted_noise();
  return rounds.wanted > 0.0 ? rounds.wanted : std::numeric_limits<double>::infinity();
}

std::vector<std::uint32_t> KeptRays::wanting(const SampleSet& samples, double noise, double solve_seconds) const {
  RayBudget budget;
  if (settings_.target_rmse > 0.0 && has_begun()) {
    if (!(squared(standard_error(samples.variance)) > noise)) return {};
    // A little below, lest a last round serves a few sites.
    budget.mean_variance = 0.95 * noise;
  }
  if (settings_.target_seconds > 0.0) {
    // The time of solving grows with the rays, which may double.
    const double left = settings_.target_seconds - since_.seconds() - 2.0 * solve_seconds;
    budget.rays = left * double(rays()) / std::max(trace_seconds_, 1e-9);
    if (budget.rays < 0.02 * double(rays())) return {};
  }
  if (settings_.trace.bounces != 0) {
    const double room = double(most_kept_rays(settings_)) - double(rays());
    if (room < 0.02 * double(rays())) return {};
    budget.rays = std::min(budget.rays, room);
  }
  if (!has_begun() && budget.rays >= double(rays())) return all_that_are_lit(samples.variance);
  return sites_to_double(samples.variance, links_->rays(), budget);
}

BakeSettings KeptRays::settings_to_judge() const {
  // Paths of places are some eight rays: an eighth of the time's, at the pace of the first rays, then goes into them.
  constexpr double kShare = 1.0 / 64.0;
  BakeSettings settings = settings_;
  if (!(settings.target_seconds > 0.0)) return settings;
  const double of_each = first_rays(settings) * settings.target_seconds / std::max(trace_seconds_, 1e-9);
  settings.trace.rays = int(std::clamp(kShare * of_each, 1.0, 4096.0));
  settings.target_rmse = 0.0;
  return settings;
}

SampleSet KeptRays::trace_and_solve(const Scene& scene, const Run& run, BakeResult& result) {
  Stopwatch solving;
  Solution solution = solve(scene, run, result);
  double worth = 0.0;
  for (int round = 0; has_target(settings_) && round < kMostRounds; ++round) {
    worth = noise_worth_rays(solution.samples, run, result);
    const std::vector<std::uint32_t> sites = wanting(solution.samples, worth, solving.seconds());
    if (sites.empty()) break;
    const Stopwatch watch;
    links_->extend(sites, run);
    trace_seconds_ += watch.seconds();
    if (texel_rounds_ != nullptr) texel_rounds_->is_lit = false;
    solving = Stopwatch();
    solution = solve(scene, run, result);
  }
  result.seconds["trace"] = trace_seconds_ + judge_seconds_;
  result.counters = links_->counters();
  add(result.counters, solution.counters);
  if (judge_ != nullptr) count_judging(judge_->held_out(), result);
  if (texel_rounds_ != nullptr) count_judging(texel_rounds_->judge.held_out(), result);
  result.reading_error = reading_error(solution.samples);
  if (settings_.trace.bounces == kAllBounces && solution.sweeps >= SolveSettings{}.most_sweeps)
    result.skipped["sweeps_beyond_limit"] = 1;
  result.settings = settings_;
  result.least_rays = result.most_rays = std::uint32_t(settings_.trace.rays);
  if (const auto rays = links_->rays(); !rays.empty()) {
    const auto [least, most] = std::minmax_element(rays.begin(), rays.end());
    result.least_rays = *least;
    result.most_rays = *most;
  }
  result.link_bytes = links_->bytes();
  const bool missed = settings_.target_rmse > 0.0 && squared(standard_error(solution.samples.variance)) > worth;
  if (settings_.trace.bounces != 0 && missed && !(settings_.target_seconds > 0.0))
    result.skipped["rounds_beyond_memory"] = 1;
  if (texel_rounds_ != nullptr && texel_rounds_->target.is_beyond_rays()) result.skipped["error_beyond_rays"] = 1;
  return std::move(solution.samples);
}

}  // namespace isolux
