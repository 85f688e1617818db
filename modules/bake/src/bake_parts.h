#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// Whether rays are to be spent until something is reached.
[[nodiscard]] inline bool has_target(const BakeSettings& settings) {
  return settings.target_rmse > 0.0 || settings.target_seconds > 0.0;
}

/// \throw InvalidInput if the volume is not usable or constant, or the isovalues asked for lie outside its values
void require_lightable(const Volume& volume, const BakeSettings& settings);

/// What a sampler is asked for, but for the number of sites a texel.
[[nodiscard]] SiteRequest site_request(const BakeSettings& settings, const Lattice& texels, OuterSide outer);

/// The samples as a grid, with their error.
void finish_bake(const Volume& volume, const SampleSet& samples, const Resampler& resampler, const Lattice& texels,
                 const BakeSettings& settings, const Run& run, BakeResult& result);

}  // namespace isolux
