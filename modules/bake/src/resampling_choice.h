#pragma once

#include <isolux/bake/bake.h>
#include <isolux/resample/fill_unlit.h>

namespace isolux {

/// Names the sampler and the resampler where the user has not.
void name_resampling(BakeSettings& settings);

/// Fills in how many texels and sites they want, and what the fit tells of a texel. \pre name_resampling()
void choose_density(BakeSettings& settings, const Lattice& volume);

/// settings.sites_a_cell by texel; 1 where it is 0. \pre choose_density()
[[nodiscard]] double sites_a_texel(const Lattice& volume, const Lattice& texels, const BakeSettings& settings);

/// How far texels are filled: everywhere, or about known level sets only, which leaves the rest 0.
[[nodiscard]] FillSettings fill_for(const BakeSettings& settings);

}  // namespace isolux
