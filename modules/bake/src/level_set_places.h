#pragma once

#include <isolux/core/run.h>
#include <isolux/sample_sites/site_sampler.h>

#include <cstddef>

namespace isolux {

/// Some `count` places of the level sets of request.isovalues, as they are looked at: every other one between the
/// volume's grid lines, as pixels are, the rest on them, as vertices of meshes are, where light is often half as wrong
/// again. Other places than the sampler `level_sets` gives for the same run. \throw Cancelled
[[nodiscard]] Sites level_set_places(const Volume& volume, SiteRequest request, std::size_t count, const Run& run);

}  // namespace isolux
