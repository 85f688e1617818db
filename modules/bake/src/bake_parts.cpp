#include "bake_parts.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/machine_memory.h>
#include <isolux/core/release.h>
#include <isolux/core/stopwatch.h>
#include <isolux/resample/fill_unlit.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "resampling_choice.h"
#include "standard_error.h"
#include "texel_judge.h"

namespace isolux {
namespace {

/// The machine says only later, if at all, that there is not so much: after minutes in a grid's first pages. \throw
/// InvalidInput
void require_memory(const Index3& texels) {
  const double bytes = double(sizeof(float)) * texels.x * texels.y * texels.z;
  const double there = machine_memory();
  if (bytes <= there) return;
  throw InvalidInput(fmt::format("{}x{}x{} texels take {:.1f} GB, and this machine has {:.1f} GB of memory", texels.x,
                                 texels.y, texels.z, bytes * 1e-9, there * 1e-9));
}

/// What a resampler of anybody's was asked for. \throw InvalidInput naming it and what is not so
void require_resampled(const ResampledGrid& partial, const Lattice& texels, int channels, const std::string& name) {
  const auto refuse = [&](const std::string& what) { throw InvalidInput(fmt::format("resampler {}: {}", name, what)); };
  const IlluminationGrid& grid = partial.grid;
  const Index3& size = grid.lattice.size;
  if (size != texels.size) {
    refuse(fmt::format("it gave {}x{}x{} texels and was asked for {}x{}x{}", size.x, size.y, size.z, texels.size.x,
                       texels.size.y, texels.size.z));
  }
  if (grid.lattice.frame.origin != texels.frame.origin || grid.lattice.frame.axes != texels.frame.axes)
    refuse("its texels lie elsewhere than those it was asked for");
  if (grid.channels != channels)
    refuse(fmt::format("it made {} channels of samples that have {}", grid.channels, channels));
  const std::size_t values = texels.count() * std::size_t(channels);
  if (grid.values.size() != values || partial.lit.size() != texels.count()) {
    refuse(fmt::format("it gave {} values and {} flags for {} texels of {} channels", grid.values.size(),
                       partial.lit.size(), texels.count(), channels));
  }
  const LightDetail& detail = grid.detail;
  const bool turned = !detail.normal_slopes[0].empty();
  if (!detail.slopes.empty() && detail.slopes.size() != values)
    refuse(fmt::format("it gave {} slopes for {} values", detail.slopes.size(), values));
  for (const std::vector<float>& slopes : detail.normal_slopes)
    if (slopes.size() != (turned ? values : 0))
      refuse(fmt::format("it gave {} slopes along an axis of the normal for {} values", slopes.size(), values));
  for (std::size_t t = 0, v = 0; t < texels.count(); ++t) {
    for (int c = 0; c < channels; ++c, ++v)
      if (partial.lit[t] != 0 && !std::isfinite(grid.values[v]))
        refuse(fmt::format("texel {} is lit and holds {}: light is finite", t, grid.values[v]));
  }
}

}  // namespace

void require_settings(const BakeSettings& settings) {
  const auto at_least_0 = [](const char* what, double value) {
    if (!(value >= 0.0 && std::isfinite(value)))
      throw InvalidInput(fmt::format("{} = {}: allowed are numbers of at least 0", what, value));
  };
  at_least_0("texels_a_cell", settings.texels_a_cell);
  at_least_0("sites_a_cell", settings.sites_a_cell);
  at_least_0("target_rmse", settings.target_rmse);
  at_least_0("target_seconds", settings.target_seconds);
  at_least_0("isovalue_parts", settings.isovalue_parts);
  if (settings.trace.rays < 1) throw InvalidInput(fmt::format("rays = {}: allowed is 1 and more", settings.trace.rays));
  if (const auto& range = settings.isovalues; range && !(range->low <= range->high)) {
    throw InvalidInput(
        fmt::format("isovalue range {}:{}: its first number has to be at most its second", range->low, range->high));
  }
  const bool is_wide = settings.tracer.name == "wide" && settings.tracer.settings.empty();
  if (iterates(settings) && settings.trace.bounces != 0 && !is_wide) {
    throw InvalidInput(fmt::format(
        "tracer {}: iterated reflections are traced by wide with its defaults; paths take any", settings.tracer.name));
  }
}

ValueRange require_traceable(const Volume& volume) {
  // Sums of a cell's values are taken in floats, and divided by.
  constexpr double kLeast = 0x1p-110;
  constexpr double kMost = 0x1p127;
  require_usable(volume);
  const ValueRange range = value_range(volume);
  const double span = double(range.high) - double(range.low);
  if (span == 0.0 || (span >= kLeast && span <= kMost)) return range;
  throw InvalidInput(fmt::format(
      "{}: values from {} to {} span {:.3g}; allowed are spans from {:.2g} to {:.2g}: give them another unit, or "
      "replace what stands for missing ones",
      volume.name, range.low, range.high, span, kLeast, kMost));
}

void require_level_sets(const Volume& volume, const BakeSettings& settings) {
  const ValueRange range = require_traceable(volume);
  const std::optional<ValueRange>& wanted = settings.isovalues;
  if (range.low == range.high) {
    throw InvalidInput(fmt::format("{}: every voxel is {}{}; a constant volume has no level set to light", volume.name,
                                   range.low,
                                   volume.rounded ? " since values were rounded to float32 (subtract an offset)" : ""));
  }
  if (wanted && (wanted->high < range.low || wanted->low > range.high)) {
    throw InvalidInput(fmt::format("isovalue range {}:{}: the values of {} go from {} to {}", wanted->low, wanted->high,
                                   volume.name, range.low, range.high));
  }
}

void require_lightable(const Volume& volume, const BakeSettings& settings) {
  require_level_sets(volume, settings);
  require_memory(texel_lattice(volume.lattice(), settings).size);
}

SiteRequest site_request(const Volume& volume, const BakeSettings& settings, const Lattice& texels, OuterSide outer,
                         const Run& run) {
  SiteRequest request{.texels = texels, .count = settings.samples, .outer = outer, .gradient = settings.trace.gradient};
  if (settings.sampler.name != "texels") {
    request.isovalues = settings.isovalues;
  } else if (settings.isovalues) {
    request.only = std::make_shared<const TexelMask>(texels_read_by(volume, texels, *settings.isovalues, run));
  }
  return request;
}

int kept_rays_a_site(const BakeSettings& settings, std::size_t sites, int rays) {
  constexpr int kFewest = 4;
  if (settings.trace.bounces == 0) return rays;  // a bit each, no links
  const std::uint64_t room = most_kept_rays(settings) / std::max<std::uint64_t>(sites, 1);
  if (std::uint64_t(rays) <= room) return rays;
  const int kept = int(std::bit_floor(room));
  return kept < kFewest ? 0 : kept;
}

SampleSet standard_errors(SampleSet samples, double scale) {
  samples.channels = 1;
  release(samples.lamps);  // parts of the light, not of its error
  release(samples.lamps_variance);
  samples.radiance.resize(samples.size());
  std::transform(samples.variance.begin(), samples.variance.end(), samples.radiance.begin(),
                 [scale](float variance) { return std::sqrt(variance) * float(scale); });
  return samples;
}

void keep_first(std::size_t count, SampleSet& samples) {
  const auto keep = [&](auto& array, std::size_t values) {
    if (array.size() <= values) return;
    array.resize(values);
    array.shrink_to_fit();
  };
  const std::size_t values = count * std::size_t(samples.channels);
  keep(samples.sites.positions, count);
  keep(samples.sites.isovalues, count);
  keep(samples.sites.normals, count);
  keep(samples.radiance, values);
  keep(samples.variance, count);
  keep(samples.lamps, values);
  keep(samples.lamps_variance, count);
}

void finish_light(const Volume& volume, const SampleSet& samples, ResampledGrid partial, const Resampler& resampler,
                  const BakeSettings& settings, const Run& run, BakeResult& result) {
  const int channels = partial.grid.channels;  // samples may be those of its error
  resampler.add_detail(volume, samples, partial, run);
  require_resampled(partial, texel_lattice(volume.lattice(), settings), channels, settings.resampler.name);
  result.unlit_texels = std::size_t(std::count(partial.lit.begin(), partial.lit.end(), std::uint8_t(0)));
  result.light = fill_unlit(std::move(partial), run, fill_for(settings));
  result.light.detail.isovalues = settings.isovalues;
}

void make_light(const Volume& volume, const SampleSet& samples, const Resampler& resampler, const Lattice& texels,
                const BakeSettings& settings, const Run& run, BakeResult& result) {
  const Stopwatch watch;
  ResampledGrid partial = resampler.resample(volume, samples, texels, run);
  require_resampled(partial, texels, samples.channels, settings.resampler.name);
  finish_light(volume, samples, std::move(partial), resampler, settings, run, result);
  result.seconds["resample"] += watch.seconds();
}

void make_error(const Volume& volume, SampleSet samples, const Resampler& resampler, const Lattice& texels,
                const BakeSettings& settings, const Run& run, BakeResult& result) {
  result.noise = standard_error(samples.variance);
  result.rmse_estimate = std::hypot(result.noise, result.reading_error);
  if (!settings.wants_error_grid) return;
  const Stopwatch watch;
  // Reading is wrong where rays hit, which is also where their number varies.
  const double scale = result.noise > 0.0 ? result.rmse_estimate / result.noise : 1.0;
  const SampleSet errors = standard_errors(std::move(samples), scale);
  // Of other texels it is the mean error around: what is fitted may well be below 0.
  ResampledGrid grid = are_sites_own(resampler, settings)
                           ? resampler.resample(volume, errors, texels, run)
                           : resamplers().create("cell_grid")->resample(volume, errors, texels, run);
  require_resampled(grid, texels, 1, settings.resampler.name);
  result.error = fill_unlit(std::move(grid), run);
  result.seconds["resample"] += watch.seconds();
}

void finish_bake(const Volume& volume, SampleSet samples, const Resampler& resampler, const Lattice& texels,
                 const BakeSettings& settings, const Run& run, BakeResult& result) {
  make_light(volume, samples, resampler, texels, settings, run, result);
  make_error(volume, std::move(samples), resampler, texels, settings, run, result);
}

}  // namespace isolux
