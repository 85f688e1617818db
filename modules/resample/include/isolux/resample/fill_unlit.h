#pragma once

#include <isolux/resample/resampler.h>

#include <limits>

namespace isolux {

struct FillSettings {
  int layers = std::numeric_limits<int>::max();  ///< of texels about the lit ones; what lies beyond is 0
};

/// Gives every texel that is not lit the light of the lit ones around it, so that linear filtering across the border
/// never bleeds black. Lit texels keep their bits. \throw InvalidInput if no texel is lit.
[[nodiscard]] IlluminationGrid fill_unlit(ResampledGrid partial, const Run& run, const FillSettings& settings = {});

}  // namespace isolux
