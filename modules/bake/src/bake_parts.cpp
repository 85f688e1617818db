#include "bake_parts.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/stopwatch.h>
#include <isolux/resample/fill_unlit.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "resampling_choice.h"
#include "standard_error.h"

namespace isolux {
namespace {

/// Texels whose own level set was not asked for.
std::uint64_t texels_outside(const Volume& volume, const Lattice& texels, const ValueRange& wanted, const Run& run) {
  const TrilinearField field(volume);
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  const std::size_t row = std::size_t(texels.size.x);
  const std::size_t rows = texels.count() / row;
  std::vector<std::uint64_t> outside(rows);
  parallel_blocks(rows, 1, run, "", [&](const Block& block) {
    const std::size_t y = block.index % std::size_t(texels.size.y);
    const std::size_t z = block.index / std::size_t(texels.size.y);
    for (std::size_t x = 0; x < row; ++x) {
      // The site's own position is rounded to float, as samplers do.
      const auto value = float(field.value(Vec3(Vec3f(to_volume.world({double(x), double(y), double(z)})))));
      outside[block.index] += std::uint64_t(value < wanted.low || value > wanted.high);
    }
  });
  std::uint64_t sum = 0;
  for (const std::uint64_t part : outside) sum += part;
  return sum;
}

/// Standard errors on the texels, brought there as light is.
IlluminationGrid error_grid(const Volume& volume, const SampleSet& samples, const Resampler& resampler,
                            const Lattice& texels, const Run& run) {
  SampleSet errors;
  errors.sites = samples.sites;
  errors.variance = samples.variance;
  errors.radiance.reserve(samples.size());
  for (const float variance : samples.variance) errors.radiance.push_back(std::sqrt(variance));
  return fill_unlit(resampler.resample(volume, errors, texels, run), run);
}

}  // namespace

void require_lightable(const Volume& volume, const BakeSettings& settings) {
  require_usable(volume);
  const std::optional<ValueRange>& wanted = settings.isovalues;
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

SiteRequest site_request(const BakeSettings& settings, const Lattice& texels, OuterSide outer) {
  return {.texels = texels,
          .count = settings.samples,
          .isovalues = settings.isovalues,
          .outer = outer,
          .gradient = settings.trace.gradient};
}

Sites sample_sites(const Volume& volume, OuterSide outer, const BakeSettings& settings, const Lattice& texels,
                   const Stages& stages, const Run& run, BakeResult& result) {
  require_lightable(volume, settings);
  const auto sampler = stages.samplers.create(settings.sampler.name, settings.sampler.settings);
  const Stopwatch watch;
  SiteRequest request = site_request(settings, texels, outer);
  request.per_texel = sites_a_texel(volume.lattice(), texels, settings);
  Sites sites = sampler->sample(volume, request, run);
  result.sites = sites.size();
  if (result.sites == 0)
    throw InvalidInput(fmt::format("{}: no site has a normal and an isovalue in the range", volume.name));
  if (settings.sampler.name == "texels") {
    const std::uint64_t left_out = texels.count() - sites.size();
    const std::uint64_t outside = settings.isovalues ? texels_outside(volume, texels, *settings.isovalues, run) : 0;
    result.skipped["sites_outside_iso_range"] = outside;
    result.skipped["sites_flat"] = left_out - std::min(left_out, outside);
  }
  result.seconds["sites"] = watch.seconds();
  return sites;
}

void finish_bake(const Volume& volume, const SampleSet& samples, const Resampler& resampler, const Lattice& texels,
                 const BakeSettings& settings, const Run& run, BakeResult& result) {
  result.rmse_estimate = standard_error(samples.variance);
  const Stopwatch watch;
  ResampledGrid partial = resampler.resample(volume, samples, texels, run);
  result.unlit_texels = std::size_t(std::count(partial.lit.begin(), partial.lit.end(), std::uint8_t(0)));
  result.light = fill_unlit(std::move(partial), run, fill_for(settings));
  result.light.detail.isovalues = settings.isovalues;
  if (settings.wants_error_grid) result.error = error_grid(volume, samples, resampler, texels, run);
  result.seconds["resample"] = watch.seconds();
}

}  // namespace isolux
