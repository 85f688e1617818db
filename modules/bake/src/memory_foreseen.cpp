#include <isolux/bake/memory_foreseen.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "bake_in_parts.h"
#include "bake_parts.h"
#include "resampling_choice.h"
#include "texel_judge.h"

namespace isolux {
namespace {

/// Of fixed size: rays under way, tables.
constexpr double kFixed = 4e6;
/// Of a voxel: what the tracer knows of cells.
constexpr double kTracer = 1.0;
/// A site's place, isovalue and normal.
constexpr double kSite = 28.0;
/// Rays that a site ends with where an error or a time is asked.
constexpr double kRaysToATarget = 24.0;
constexpr std::size_t kCellsLookedAt = 65536;
/// Texels that a level set is read from, by cells that it crosses, at most.
constexpr double kReadByACell = 2.5;

/// The part of the cells that have a level set which is wanted.
double crossed_part(const Volume& volume, const BakeSettings& settings) {
  const Index3& size = volume.lattice().size;
  std::size_t crossed = 0;
  RandomStream random(0, 0, 0);
  for (std::size_t n = 0; n < kCellsLookedAt; ++n) {
    Index3 i;
    for (int a = 0; a < 3; ++a) i[a] = std::min(int(random.uniform_double() * (size[a] - 1)), size[a] - 2);
    float low = volume.values(i.x, i.y, i.z);
    float high = low;
    for (int q = 1; q < 8; ++q) {
      const float value = volume.values(i.x + (q & 1), i.y + (q >> 1 & 1), i.z + (q >> 2));
      low = std::min(low, value);
      high = std::max(high, value);
    }
    const bool is_wanted = !settings.isovalues || (high >= settings.isovalues->low && low <= settings.isovalues->high);
    if (low < high && is_wanted) ++crossed;
  }
  return double(crossed) / double(kCellsLookedAt);
}

double sites_of(const Volume& volume, const Lattice& texels, const BakeSettings& settings) {
  if (settings.samples > 0) return double(settings.samples);
  const double part = crossed_part(volume, settings);
  if (settings.sampler.name != "texels")
    return double(texels.count()) * sites_a_texel(volume.lattice(), texels, settings) * part;
  return double(texels.count()) * std::min(1.0, settings.isovalues ? kReadByACell * part : part);
}

/// Of a fit: the system and its solution, by the numbers of a texel; what reflections are read from; and the samples.
double bytes_of_fit(const BakeSettings& settings, const Lattice& volume, double texels, double sites, double channels) {
  const auto has = [&](const char* what) {
    const auto it = settings.resampler.settings.find(what);
    return it == settings.resampler.settings.end() || it->second != "false";
  };
  const bool one_isovalue = settings.isovalues && settings.isovalues->low == settings.isovalues->high;
  const double numbers = 1.0 + (has("slopes") && !one_isovalue ? 1.0 : 0.0) + (has("normals") ? 3.0 : 0.0);
  double bytes = (8.0 + 10.0 * numbers * channels) * texels + (100.0 + 5.0 * channels) * sites;
  if (reads_means(settings) && iterates(settings))
    bytes += (10.0 + 10.0 * channels) * std::max(texels, double(volume.count()));
  return bytes;
}

/// Of links, whether they keep where rays end or only that they do.
double bytes_of_links(const BakeSettings& settings, double sites) {
  const double rays = has_target(settings) ? kRaysToATarget : double(settings.trace.rays);
  if (settings.trace.bounces == 0) return sites * (16.0 + rays / 8.0);
  return std::min(double(settings.most_link_bytes), sites * (14.0 + 3.3 * rays));
}

/// Beside the samples, while these are denoised: the windows of some layers.
double bytes_of_windows(const Lattice& texels, double sites, double channels, bool lamps) {
  const Index3& size = texels.size;
  const double layer = double(texels.count()) / double(std::max({size.x, size.y, size.z}));
  return std::min(layer * 7000.0, sites * 130.0) * (0.85 + 0.15 * channels) * (lamps ? 1.3 : 1.0);
}

}  // namespace

double memory_foreseen(const Volume& volume, const Scene& scene, const BakeSettings& given, const Stages& stages) {
  const BakeSettings settings = with_defaults(given, volume.lattice(), stages);
  const Lattice texels = texel_lattice(volume.lattice(), settings);
  const double sites = sites_of(volume, texels, settings);
  const double channels = is_grey(scene) ? 1.0 : 3.0;
  const double lamps = has_lamps(scene) ? 4.0 * channels + 4.0 : 0.0;
  const double light = 4.0 * channels * double(texels.count());
  const bool both = scene.sides == LitSides::kBoth;
  double always = kFixed + kTracer * double(volume.lattice().count());
  if (both) always += light + kSite * sites;  // the first side's, while the second is lit

  if (settings.texel_sites == TexelSites::kNeeded && settings.sampler.name == "texels") {
    const double known = settings.trace.bounces == 0 ? 13.0 : 10.0 + 10.0 * channels;
    return always + light + known * double(texels.count());
  }

  const auto resampler = stages.resamplers.create(settings.resampler.name, settings.resampler.settings);
  const bool denoises = resampler->lamps() == LampLight::kToldApart;
  const double sample = kSite + 4.0 * channels + 4.0 + lamps;
  if (!has_target(settings) && !denoises && can_bake_in_parts(volume, settings, stages))
    return always + light + 5.0 * sites;

  double resampling = light + sample * sites;
  if (denoises)
    resampling += bytes_of_windows(texels, sites, channels, lamps > 0.0);
  else if (settings.resampler.name == "fit")
    resampling = bytes_of_fit(settings, volume.lattice(), double(texels.count()), sites, channels);
  else if (!resampler->takes_parts())
    resampling += 38.0 * sites;
  // Sites at texels are found in pieces and joined.
  const double finding = settings.sampler.name == "texels" ? light + 2.0 * kSite * sites : 0.0;
  double tracing = sample * sites;
  if (iterates(settings) && settings.trace.bounces != 0) {
    // Seven floats a channel while reflections are iterated, and the isovalue. Under a uniform sky places may go.
    const bool lets_go = std::holds_alternative<UniformEnvironment>(scene.environment) && lamps == 0.0 &&
                         resampler->takes_parts() && !has_target(settings);
    tracing = (28.0 * channels + 4.0 + lamps + (lets_go ? 0.0 : kSite)) * sites + bytes_of_links(settings, sites);
  } else if (has_target(settings) && settings.trace.bounces == 0 && lamps == 0.0) {
    tracing = (kSite + 8.0 * channels + 8.0) * sites + bytes_of_links(settings, sites);
  }
  // Towards an error texels that several sites make are made, and judged, while rays are kept.
  if (settings.target_rmse > 0.0 && !are_sites_own(*resampler, settings) && lamps == 0.0)
    resampling += tracing - sample * sites;
  return always + std::max({finding, tracing, resampling});
}

}  // namespace isolux
