#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// Lights few texels and predicts the others until settings.target_rmse is reached; refines cells of texels or doubles
/// rays, whichever takes away more error for a ray. The error is that at texels held out: drawn at random, traced twice
/// with other random numbers, and never used for the light, so that the mean product of both differences is the mean
/// squared error whatever is wrong. \pre with_defaults(settings). \throw as bake(); InvalidInput if settings or scene
/// want what cannot be lit by need
[[nodiscard]] BakeResult bake_by_need(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                                      const Stages& stages, const Run& run);

}  // namespace isolux
