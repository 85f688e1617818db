#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// About how many bytes bake() will have at once beside the volume: before it begins, by what each texel, site and ray
/// of its way takes. The sites are counted by looking at some cells, so it costs milliseconds. Right to a factor of
/// 1.5 on volumes of 96^3 and more (docs/measured/memory.md); with BakeSettings::target_rmse or target_seconds, whose
/// rays only the bake finds, and with TexelSites::kNeeded it is what smooth light takes, and rough light more. Compare
/// it with free_memory(). \pre the volume is usable (require_usable()) \throw InvalidInput as bake()
[[nodiscard]] double memory_foreseen(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                                     const Stages& stages);

}  // namespace isolux
