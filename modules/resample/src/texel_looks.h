#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <cstdint>
#include <span>
#include <vector>

#include "lit_texels.h"
#include "wide/lattice_samples.h"

namespace isolux {

/// Writes the looks of some of the sites, but for their light: isovalues in mean grid spacings, normals, and the
/// openness in front of them. \pre all.channels
void look_at(const Volume& volume, const Sites& sites, std::span<const std::uint32_t> which, const Run& run,
             wide::LatticeSamples& all);

/// Writes the light of texels times `unit`, and its variance: of several samples at a texel the mean, as of independent
/// ones. \pre look_at() of texels.sites
void take_light(const std::vector<float>& radiance, const std::vector<float>& variance, const LitTexels& texels,
                float unit, wide::LatticeSamples& all);

}  // namespace isolux
