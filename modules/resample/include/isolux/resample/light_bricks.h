#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/light_bricks.h>
#include <isolux/core/volume.h>

namespace isolux {

/// Values and slopes of all kinds of `light` about the level sets of `isovalues`. Cost: one pass over the volume.
[[nodiscard]] LightBricks make_light_bricks(const Volume& volume, const IlluminationGrid& light,
                                            const ValueRange& isovalues);

}  // namespace isolux
