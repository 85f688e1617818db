#pragma once

#include <isolux/bake/bake.h>

#include <cstddef>
#include <cstdint>

namespace isolux {

/// Rays a site before anything is known: the smallest net that tells sites apart.
inline constexpr int kFirstRays = 16;
/// In a time, which may be too short for them.
inline constexpr int kFirstRaysInATime = 4;

/// Whether rays are to be spent until something is reached.
[[nodiscard]] inline bool has_target(const BakeSettings& settings) {
  return settings.target_rmse > 0.0 || settings.target_seconds > 0.0;
}

/// Where has_target().
[[nodiscard]] inline int first_rays(const BakeSettings& settings) {
  return settings.target_seconds > 0.0 ? kFirstRaysInATime : kFirstRays;
}

/// Whether reflections are read from means of scattered sites (TexelMeans): a whole fit a sweep would cost more than
/// the rays.
[[nodiscard]] inline bool reads_means(const BakeSettings& settings) {
  return settings.resampler.name == "fit" && settings.trace.bounces != 0;
}

/// Of all sites; a link takes four bytes.
[[nodiscard]] inline std::uint64_t most_kept_rays(const BakeSettings& settings) { return settings.most_link_bytes / 4; }
/// Of `rays` rays of each site, how many are kept for BounceMethod::kIterated: all, or as large a power of two as
/// memory allows; 0 if that is too few to iterate over. Without bounces all: they have no links.
[[nodiscard]] int kept_rays_a_site(const BakeSettings& settings, std::size_t sites, int rays);

/// \throw InvalidInput for numbers that mean nothing, and for a tracer that iterated reflections would not use
void require_settings(const BakeSettings& settings);

/// The range of the values. \throw InvalidInput if the volume is not usable, or its values lie so close together or so
/// far apart that floats do not hold what rays are worked out by
ValueRange require_traceable(const Volume& volume);

/// \throw InvalidInput if the volume is not traceable or constant, or the isovalues asked for lie outside its values
void require_level_sets(const Volume& volume, const BakeSettings& settings);
/// The same, and \throw InvalidInput if the texels take more memory than the machine has
void require_lightable(const Volume& volume, const BakeSettings& settings);

/// What a sampler is asked for, but for the number of sites a texel. Of known isovalues sites at texels are those that
/// these level sets are read from; others lie on them. \throw Cancelled
[[nodiscard]] SiteRequest site_request(const Volume& volume, const BakeSettings& settings, const Lattice& texels,
                                       OuterSide outer, const Run& run);

/// Of samples of all texels, what a resampler is shown where they are put into the grid part by part: all would take
/// more than was saved.
inline constexpr std::size_t kSamplesShown = 16384;
/// Leaves the first `count` samples.
void keep_first(std::size_t count, SampleSet& samples);

/// Samples of their standard error, times `scale`, instead of light.
[[nodiscard]] SampleSet standard_errors(SampleSet samples, double scale = 1.0);

/// A grid that `resampler` made of these samples, and perhaps of others like them, as the light of the bake.
void finish_light(const Volume& volume, const SampleSet& samples, ResampledGrid partial, const Resampler& resampler,
                  const BakeSettings& settings, const Run& run, BakeResult& result);

/// The samples as a grid.
void make_light(const Volume& volume, const SampleSet& samples, const Resampler& resampler, const Lattice& texels,
                const BakeSettings& settings, const Run& run, BakeResult& result);
/// Their error, and if it is wanted as a grid.
void make_error(const Volume& volume, SampleSet samples, const Resampler& resampler, const Lattice& texels,
                const BakeSettings& settings, const Run& run, BakeResult& result);
/// Both.
void finish_bake(const Volume& volume, SampleSet samples, const Resampler& resampler, const Lattice& texels,
                 const BakeSettings& settings, const Run& run, BakeResult& result);

}  // namespace isolux
