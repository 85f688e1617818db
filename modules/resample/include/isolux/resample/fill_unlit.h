#pragma once

#include <isolux/resample/resampler.h>

namespace isolux {

/// Gives every texel that is not lit the light of the lit ones around it, so that linear filtering across the border
/// never bleeds black. Lit texels keep their bits. \throw InvalidInput if no texel is lit.
[[nodiscard]] IlluminationGrid fill_unlit(ResampledGrid partial, const Run& run);

}  // namespace isolux
