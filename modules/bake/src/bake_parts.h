#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// Whether rays are to be spent until something is reached.
[[nodiscard]] inline bool has_target(const BakeSettings& settings) {
  return settings.target_rmse > 0.0 || settings.target_seconds > 0.0;
}

/// The sites of a bake; counts those left out in result.skipped. \throw InvalidInput if the volume is not usable or no
/// site is found
[[nodiscard]] Sites sample_sites(const Volume& volume, OuterSide outer, const BakeSettings& settings,
                                 const Lattice& texels, const Stages& stages, const Run& run, BakeResult& result);

/// The samples as a grid, with their error.
void finish_bake(const Volume& volume, const SampleSet& samples, const Resampler& resampler, const Lattice& texels,
                 const BakeSettings& settings, const Run& run, BakeResult& result);

}  // namespace isolux
