#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// Whether sites may come and go, part by part of the isovalues: they sit at the texels, one a cell at most, their
/// light is all that is wanted of them, and the resampler takes it so. \pre with_defaults(settings), no target
[[nodiscard]] bool can_bake_in_parts(const Volume& volume, const BakeSettings& settings, const Stages& stages);

/// Lights the outer side of `scene` by the tracer, the sites of some isovalues after those of others, and keeps of each
/// part its light alone. A ray meets its own site's isovalue only, so a part's light is what it is among all others.
/// `begun`: what is known already. \pre can_bake_in_parts() \throw as bake()
[[nodiscard]] BakeResult bake_in_parts(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                                       BakeResult begun, const Stages& stages, const Run& run);

}  // namespace isolux
