#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// The bakes of the two sides as one. \pre of the same texels and settings
[[nodiscard]] BakeResult both_sides(BakeResult outer, BakeResult inner);

}  // namespace isolux
