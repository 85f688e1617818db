#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/run.h>

namespace isolux {

/// Takes a little of each texel's second differences off it, as reading between texels cuts off crests and fills
/// valleys (Blu, Thevenaz & Unser, "Linear interpolation revitalized", IEEE Trans. Image Processing 2004). It makes
/// noise louder, and is for light without. Along an axis only where both neighbours are lit; texels that equal `before`
/// stay, and none falls below 0. \pre unlit_grid()s with light in the same texels
void sharpen(IlluminationGrid& light, const IlluminationGrid& before, const Run& run);

}  // namespace isolux
