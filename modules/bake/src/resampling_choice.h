#pragma once

#include <isolux/bake/bake.h>
#include <isolux/resample/fill_unlit.h>

namespace isolux {

/// Names the sampler and the resampler where the user has not, and fills in the texels and sites that they want.
void choose_resampling(BakeSettings& settings);

/// Texels a cell and axis, the axes' geometric mean.
[[nodiscard]] double density_of(const Lattice& volume, const Index3& texels);

/// settings.sites_a_cell by texel; 1 where it is 0. \pre choose_resampling()
[[nodiscard]] double sites_a_texel(const Lattice& volume, const Lattice& texels, const BakeSettings& settings);

/// How far texels are filled: everywhere, or about known level sets only, which leaves the rest 0.
[[nodiscard]] FillSettings fill_for(const BakeSettings& settings);

}  // namespace isolux
