#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// Whether a texel's light is that of its one site, so that its error is the site's.
[[nodiscard]] bool are_sites_own(const Resampler& resampler, const BakeSettings& settings);

/// Finds what the light of a bake is wrong by where it is read, if that is not its sites' own error: noise that
/// averages out over many sites, and what lies between them. Some texels, of a small grid all, are lit by paths; of
/// known isovalues points of their level sets. Sets result.rmse_estimate and the scale of result.error, adds rays and
/// seconds. Does nothing where hardly any place can be lit. \pre the light is of scene's outer side \throw Cancelled
void judge_texels(const Volume& volume, const Scene& scene, const BakeSettings& settings, const Run& run,
                  BakeResult& result);

}  // namespace isolux
