#pragma once

#include <isolux/bake/bake.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// Rising ranges of isovalues that together hold all the sites that `request` puts at texels, each about as many:
/// `count` ranges, or with 0 so many that each has a site for 64 voxels, at least 65,536 sites, but no more than 64
/// ranges. Where many sites share an isovalue, the range that has it can be larger, and there may be up to twice as
/// many ranges to keep the others from growing. The same for any number of threads.
[[nodiscard]] std::vector<ValueRange> isovalue_parts(const Volume& volume, const SiteRequest& request,
                                                     std::size_t count, const Run& run);

}  // namespace isolux
