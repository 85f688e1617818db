#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/run.h>
#include <isolux/core/volume.h>
#include <isolux/resample/resampler.h>

#include <array>

namespace isolux {

/// Where openness_before() looks. Half a step is one of a fit's but not one of these: at cell centres it says other
/// things than elsewhere (docs/measured/resampling.md, "The near field of texels' own light").
inline constexpr std::array<double, 3> kOwnSteps = {1.0, 2.0, 4.0};

/// Near-field terms for texels that keep their own light (TexelLight::kOwn): the weights with which the texels'
/// openness best foretells how each differs from the mean of its opposite neighbours, by weighted least squares. Noise
/// of the light is in what is foretold alone, so it does not bias them. Terms that explain no more than chance would
/// are left out; then `texels.grid.detail` stays as it is. `outwards` as NearField::outwards(). Equal bits for any
/// number of threads; some tenths of a microsecond a texel.
void estimate_near_field(const Volume& volume, double outwards, ResampledGrid& texels, const Run& run);

/// Takes the near field off texels that have it in their own light, so that a reader adds it where it reads. Texels
/// that cannot have been lit are left: their light is their neighbours'. \pre TexelLight::kOwn
void take_off_near_field(const Volume& volume, IlluminationGrid& light, const Run& run);

}  // namespace isolux
