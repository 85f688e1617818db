#include <fmt/format.h>
#include <isolux/bake/bake.h>
#include <isolux/bake/choose_texels.h>
#include <isolux/bake/kept_rays.h>
#include <isolux/core/error.h>
#include <isolux/core/plain_floats.h>
#include <isolux/core/stopwatch.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "bake_in_parts.h"
#include "bake_parts.h"
#include "both_sides.h"
#include "checked_stages.h"
#include "light_by_need.h"
#include "reading_error.h"
#include "resampling_choice.h"
#include "sites_by_need.h"
#include "texel_judge.h"
#include "texel_target.h"

namespace isolux {
namespace {

/// More rays than a bake says an error takes: it knows its own error to some percent.
constexpr double kMargin = 1.15;
/// Where iteration took no more, paths to the same error, ten to thirty times as many rays, are still a matter of
/// seconds.
constexpr std::uint64_t kMostRaysOnceMore = 20'000'000;
/// A last round takes that much longer than was foreseen before it is worth a word.
constexpr double kOvertime = 1.25;
constexpr double kLeastSeconds = 1e-3;  ///< where a time is over before any ray

BakeResult bake_paths(const Volume& volume, const Scene& scene, const BakeSettings& settings, FoundSites found,
                      const Stages& stages, const Run& run) {
  const auto resampler = stages.resamplers.create(settings.resampler.name, settings.resampler.settings);
  const auto tracer = checked_tracer(settings.tracer, stages);
  const Lattice texels = texel_lattice(volume.lattice(), settings);
  BakeResult result = std::move(found.begun);
  const Stopwatch watch;
  TraceSettings trace = settings.trace;
  trace.nets = RayNets::kInterleaved;
  trace.lamps = resampler->lamps();
  trace.spread = resampler->spread();
  TraceResult traced = tracer->trace(volume, scene, std::move(found.sites), trace, run);
  result.seconds["trace"] = watch.seconds();
  result.counters = traced.counters;
  result.least_rays = result.most_rays = std::uint32_t(settings.trace.rays);
  if (!traced.rays.empty()) {
    const auto [least, most] = std::minmax_element(traced.rays.begin(), traced.rays.end());
    result.least_rays = *least;
    result.most_rays = *most;
  }
  finish_bake(volume, std::move(traced.samples), *resampler, texels, settings, run, result);
  if (!are_sites_own(*resampler, settings)) judge_texels(volume, scene, settings, run, result);
  return result;
}

/// Whether sites are so many that not even a few rays of each can be kept.
bool keeps_too_few(const BakeSettings& settings, std::size_t sites) {
  return iterates(settings) && kept_rays_a_site(settings, sites, std::max(settings.trace.rays, 1)) == 0;
}

/// Without bounces kept rays see what the wide tracer sees, unless that one aims at light sources or at the bright
/// parts of an image.
bool keeps_rays(const BakeSettings& settings, const Scene& scene, std::size_t sites) {
  // Rays can be doubled only where all are kept.
  if (iterates(settings))
    return !has_target(settings) ||
           (!has_lamps(scene) && kept_rays_a_site(settings, sites, first_rays(settings)) == first_rays(settings));
  return has_target(settings) && settings.trace.bounces == 0 && settings.tracer.name == "wide" && !has_lamps(scene);
}

/// Whether no sites have to be found beforehand.
bool in_parts(const Volume& volume, const Scene& scene, const BakeSettings& settings, const Stages& stages) {
  return can_bake_in_parts(volume, settings, stages) && !keeps_rays(settings, scene, 0);
}

BakeResult bake_side(const Volume& volume, const Scene& scene, const BakeSettings& settings, FoundSites found,
                     const Stages& stages, const Run& run);

/// Whether reflections have to be followed by paths to reach the error asked.
bool wants_paths(const BakeSettings& settings, const BakeResult& iterated) {
  return settings.bounce_method == BounceMethod::kIteratedOrPaths && settings.target_rmse > 0.0 &&
         iterated.rmse_estimate > settings.target_rmse && iterated.counters.rays <= kMostRaysOnceMore &&
         !reading_allows(settings.target_rmse, iterated.reading_error);
}

/// By what to multiply the rays of a bake so that their noise is what an error allows; 0 where it is.
double more_rays_for(double target_rmse, const BakeResult& seen) {
  const double noise = seen.noise * seen.noise;
  const double allowed = squared_noise_for(target_rmse, seen.reading_error);
  return noise > allowed ? kMargin * noise / allowed : 0.0;
}

/// The same where texels are made of several sites.
double more_rays_for(TexelTarget& target, const HeldOut::SquaredError& error, const BakeResult& seen) {
  const double noise = seen.noise * seen.noise;
  target.add(noise, error);
  const double wanted = target.wanted_noise();
  return wanted > 0.0 ? kMargin * noise / wanted : 0.0;
}

/// One number of rays for all sites: more of them until a bake says that it is enough. What a few rays show of many is
/// far too much where light is rough, as the noise of nets falls faster than that of independent rays.
BakeResult bake_towards_target(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                               const FoundSites& found, const Stages& stages, const Run& run) {
  constexpr double kMostRays = 0x1p20;
  constexpr double kMostAStep = 4.0;
  constexpr double kLeastAStep = 1.2;
  const Stopwatch watch;
  BakeSettings step = settings;
  step.target_rmse = step.target_seconds = 0.0;
  step.trace.rays = first_rays(settings);
  const auto resampler = stages.resamplers.create(settings.resampler.name, settings.resampler.settings);
  std::optional<TexelJudge> judge;
  if (settings.target_rmse > 0.0 && !(settings.target_seconds > 0.0) && !are_sites_own(*resampler, settings))
    judge.emplace(volume, scene, settings, found.sites.size(), run);
  TexelTarget texels(settings.target_rmse);
  for (;;) {
    const double before = watch.seconds();
    BakeResult result = bake_side(volume, scene, step, found, stages, run);
    result.seconds["pilot"] = before;
    const double rays = step.trace.rays;
    double factor = std::numeric_limits<double>::infinity();
    if (settings.target_rmse > 0.0) {
      // Of fewer rays all may miss what is bright.
      std::optional<HeldOut::SquaredError> error;
      if (judge) error = judge->squared_error(result.light, run);
      if (judge) count_judging(judge->held_out(), result);
      tell_error(error, result);
      double wanted = kMostAStep;
      if (rays >= kFirstRays)
        wanted = error ? more_rays_for(texels, *error, result) : more_rays_for(settings.target_rmse, result);
      if (texels.is_beyond_rays()) result.skipped["error_beyond_rays"] = 1;
      if (wanted == 0.0 || wants_paths(settings, result)) return result;
      factor = std::clamp(wanted, kLeastAStep, kMostAStep);
    }
    if (settings.target_seconds > 0.0)
      factor = std::min(factor, (settings.target_seconds - watch.seconds()) / (watch.seconds() - before));
    if (factor < kLeastAStep || rays >= kMostRays) return result;
    step.trace.rays = int(std::min(std::ceil(rays * factor), kMostRays));
  }
}

/// After `seconds` that found reading reflections from texels as wrong as the light may be.
BakeResult bake_by_paths_instead(const Volume& volume, const Scene& scene, BakeSettings settings, double seconds,
                                 const Stages& stages, const Run& run) {
  settings.bounce_method = BounceMethod::kPaths;
  BakeResult result =
      bake_side(volume, scene, settings, find_sites(volume, scene.outer, settings, stages, run), stages, run);
  result.skipped["reading_beyond_error"] = 1;
  result.seconds["pilot"] += seconds;
  return result;
}

/// Lights the outer side of `scene`.
BakeResult bake_side(const Volume& volume, const Scene& scene, const BakeSettings& settings, FoundSites found,
                     const Stages& stages, const Run& run) {
  if (settings.texel_sites == TexelSites::kNeeded) {
    const auto by_need = settings.sampler.name == "texels" ? bake_by_need : bake_scattered_by_need;
    return by_need(volume, scene, settings, stages, run);
  }
  if (keeps_too_few(settings, found.sites.size())) {
    found.begun.skipped["links_beyond_memory"] = std::uint64_t(found.sites.size()) * std::uint64_t(settings.trace.rays);
    BakeSettings by_paths = settings;
    by_paths.bounce_method = BounceMethod::kPaths;
    return bake_side(volume, scene, by_paths, std::move(found), stages, run);
  }
  const Stopwatch watch;
  if (keeps_rays(settings, scene, found.sites.size())) {
    BakeResult result = KeptRays(volume, scene, settings, std::move(found), stages, run).last_light(scene, run);
    if (!wants_paths(settings, result)) return result;
    return bake_by_paths_instead(volume, scene, settings, watch.seconds(), stages, run);
  }
  if (!has_target(settings)) {
    if (!can_bake_in_parts(volume, settings, stages))
      return bake_paths(volume, scene, settings, std::move(found), stages, run);
    found.sites = {};
    return bake_in_parts(volume, scene, settings, std::move(found.begun), stages, run);
  }
  BakeResult result = bake_towards_target(volume, scene, settings, found, stages, run);
  if (!wants_paths(settings, result)) return result;
  return bake_by_paths_instead(volume, scene, settings, watch.seconds(), stages, run);
}

/// Both sides, one after the other: no ray goes from one to the other. A time is shared.
BakeResult bake_both(const Volume& volume, const Scene& scene, const BakeSettings& given, FoundSites found,
                     const Stages& stages, const Run& run) {
  const Stopwatch watch;
  BakeSettings settings = given;
  settings.target_seconds = 0.5 * given.target_seconds;
  BakeResult outer = bake_side(volume, scene_of_side(scene, LevelSetSide::kOuter), settings, found, stages, run);
  if (given.target_seconds > 0.0)
    settings.target_seconds = std::max(given.target_seconds - watch.seconds(), kLeastSeconds);
  BakeResult inner = bake_side(volume, scene_of_side(scene, LevelSetSide::kInner), settings,
                               turned_round(std::move(found)), stages, run);
  return both_sides(std::move(outer), std::move(inner));
}

/// What counts against BakeSettings::target_seconds.
double seconds_of_light(const BakeResult& result) {
  double seconds = 0.0;
  for (const auto& [stage, taken] : result.seconds)
    if (stage != "resample") seconds += taken;
  return seconds;
}

/// Iterations leave sweeps.
BakeSettings as_done(BakeSettings settings, const BakeResult& result) {
  if (settings.trace.bounces != 0)
    settings.bounce_method = result.sweeps > 0 ? BounceMethod::kIterated : BounceMethod::kPaths;
  return settings;
}

}  // namespace

Lattice texel_lattice(const Lattice& volume, const BakeSettings& settings) {
  if (settings.lattice == TexelLattice::kVoxels) {
    if (settings.texels && *settings.texels != volume.size) {
      throw InvalidInput(fmt::format("{}x{}x{} texels at the voxels: the volume has {}x{}x{} of them",
                                     settings.texels->x, settings.texels->y, settings.texels->z, volume.size.x,
                                     volume.size.y, volume.size.z));
    }
    return voxel_lattice(volume);
  }
  if (settings.texels) return cell_lattice(volume, *settings.texels);
  const double ratio = settings.texels_a_cell > 0.0 ? settings.texels_a_cell : 1.0;
  return cell_lattice(volume, texels_by_ratio(volume, ratio));
}

BakeSettings with_backends(BakeSettings settings, const Stages& stages) {
  name_resampling(settings);
  if (settings.bounce_method == BounceMethod::kDefault) {
    // Sites drawn by need are traced in two halves, the second where the first one's light changes: by paths.
    const bool keeps = settings.resampler.name == "direct" ||
                       (settings.resampler.name == "fit" && settings.texel_sites == TexelSites::kAll);
    // Iterated, `wide` traces with its defaults: who wants anything else of a tracer gets paths.
    const std::string tracer = stages.tracers.info({}).name;
    const bool any_tracer = settings.tracer.name.empty() && settings.tracer.settings.empty() && tracer == "wide";
    const bool iterated = any_tracer && keeps && settings.trace.bounces != 0;
    const bool by_error =
        settings.target_rmse > 0.0 && !(settings.target_seconds > 0.0) && settings.texel_sites == TexelSites::kAll;
    const BounceMethod iterating = by_error ? BounceMethod::kIteratedOrPaths : BounceMethod::kIterated;
    settings.bounce_method = iterated ? iterating : BounceMethod::kPaths;
  }
  if (settings.tracer.name.empty()) settings.tracer.name = stages.tracers.info({}).name;
  return settings;
}

BakeSettings with_defaults(BakeSettings settings, const Lattice& volume, const Stages& stages) {
  settings = with_backends(std::move(settings), stages);
  choose_density(settings, volume);
  return settings;
}

BakeResult bake(const Volume& volume, const Scene& scene, const BakeSettings& given, const Stages& stages,
                const Run& run) {
  const PlainFloats plain;
  BakeSettings settings = with_defaults(given, volume.lattice(), stages);
  const Stopwatch watch;
  require_settings(settings);
  require_lightable(volume, settings);
  FoundSites found;  // by need and in parts they are found when they are wanted
  if (settings.texel_sites == TexelSites::kAll && !in_parts(volume, scene, settings, stages))
    found = find_sites(volume, scene.outer, settings, stages, run);
  if (settings.target_seconds > 0.0)
    settings.target_seconds = std::max(settings.target_seconds - watch.seconds(), kLeastSeconds);
  const auto light = scene.sides == LitSides::kBoth ? bake_both : bake_side;
  BakeResult result = light(volume, scene, settings, std::move(found), stages, run);
  settings.target_seconds = given.target_seconds;
  const double seconds = seconds_of_light(result);
  if (given.target_seconds > 0.0 && seconds > kOvertime * given.target_seconds)
    result.seconds_beyond_time = seconds - given.target_seconds;
  // By need and iterated, paths only judge, without those that are cut off.
  if (result.sweeps == 0 && settings.texel_sites == TexelSites::kAll && result.counters.cut > 0)
    result.skipped["paths_cut"] = result.counters.cut;
  result.settings = as_done(std::move(settings), result);
  return result;
}

}  // namespace isolux
