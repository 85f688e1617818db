#include <fmt/format.h>
#include <isolux/bake/bake.h>
#include <isolux/core/error.h>
#include <isolux/core/stopwatch.h>
#include <isolux/raytrace_flat/light_links.h>
#include <isolux/resample/fill_unlit.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "resampling_choice.h"
#include "standard_error.h"

namespace isolux {
namespace {

void require_range(const Volume& volume, const std::optional<ValueRange>& wanted) {
  const ValueRange range = value_range(volume);
  if (range.low == range.high) {
    throw InvalidInput(
        fmt::format("{}: every voxel is {}; a constant volume has no level set to light", volume.name, range.low));
  }
  if (wanted && (wanted->high < range.low || wanted->low > range.high)) {
    throw InvalidInput(fmt::format("isovalue range {}:{}: the values of {} go from {} to {}", wanted->low, wanted->high,
                                   volume.name, range.low, range.high));
  }
}

SampleSet trace_paths(const Volume& volume, const Scene& scene, Sites sites, const BakeSettings& settings,
                      const Stages& stages, const Run& run, BakeResult& result) {
  const Stopwatch watch;
  const auto tracer = stages.tracers.create(settings.tracer.name, settings.tracer.settings);
  TraceResult traced = tracer->trace(volume, scene, std::move(sites), settings.trace, run);
  result.seconds["trace"] = watch.seconds();
  result.counters = traced.counters;
  return std::move(traced.samples);
}

SampleSet iterate(const Volume& volume, const Scene& scene, Sites sites, const BakeSettings& settings,
                  const Resampler& resampler, const Lattice& texels, const Run& run, BakeResult& result) {
  const Stopwatch trace_watch;
  const LightLinks links(volume, std::move(sites), {.rays = settings.trace.rays, .outer = scene.outer}, run);
  result.seconds["trace"] = trace_watch.seconds();
  const Stopwatch bounce_watch;
  const auto to_grid = [&](const SampleSet& samples) {
    return fill_unlit(resampler.resample(volume, samples, texels, run), run);
  };
  Solution solution =
      links.solve(scene, {.bounces = settings.trace.bounces, .gradient = settings.trace.gradient}, to_grid, run);
  result.seconds["bounces"] = bounce_watch.seconds();
  result.sweeps = solution.sweeps;
  result.counters = links.counters();
  result.counters.rays += solution.counters.rays;
  return std::move(solution.samples);
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
  return cell_lattice(volume, (volume.size - 1) * std::max(1, settings.texels_a_cell));
}

BakeSettings with_defaults(BakeSettings settings, const Stages& stages) {
  choose_resampling(settings);
  if (settings.bounce_method == BounceMethod::kDefault) {
    const bool iterated =
        settings.tracer.name.empty() && settings.resampler.name == "direct" && settings.trace.bounces != 0;
    settings.bounce_method = iterated ? BounceMethod::kIterated : BounceMethod::kPaths;
  }
  if (settings.tracer.name.empty()) settings.tracer.name = stages.tracers.info({}).name;
  return settings;
}

BakeResult bake(const Volume& volume, const Scene& scene, const BakeSettings& given, const Stages& stages,
                const Run& run) {
  const BakeSettings settings = with_defaults(given, stages);
  require_usable(volume);
  require_range(volume, settings.isovalues);
  const auto sampler = stages.samplers.create(settings.sampler.name, settings.sampler.settings);
  const auto resampler = stages.resamplers.create(settings.resampler.name, settings.resampler.settings);
  const Lattice texels = texel_lattice(volume.lattice(), settings);

  BakeResult result;
  const Stopwatch sites_watch;
  Sites sites = sampler->sample(volume,
                                {.texels = texels,
                                 .count = settings.samples,
                                 .per_texel = sites_a_texel(volume.lattice(), texels, settings),
                                 .isovalues = settings.isovalues,
                                 .outer = scene.outer,
                                 .gradient = settings.trace.gradient},
                                run);
  result.seconds["sites"] = sites_watch.seconds();
  result.sites = sites.size();
  if (result.sites == 0)
    throw InvalidInput(fmt::format("{}: no site has a normal and an isovalue in the range", volume.name));

  const SampleSet samples = settings.bounce_method == BounceMethod::kIterated
                                ? iterate(volume, scene, std::move(sites), settings, *resampler, texels, run, result)
                                : trace_paths(volume, scene, std::move(sites), settings, stages, run, result);
  result.rmse_estimate = standard_error(samples.variance);

  const Stopwatch resample_watch;
  ResampledGrid partial = resampler->resample(volume, samples, texels, run);
  result.unlit_texels = std::size_t(std::count(partial.lit.begin(), partial.lit.end(), std::uint8_t(0)));
  result.light = fill_unlit(std::move(partial), run, fill_for(settings));
  result.light.detail.isovalues = settings.isovalues;
  result.seconds["resample"] = resample_watch.seconds();
  return result;
}

}  // namespace isolux
