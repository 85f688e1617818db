#pragma once

#include <isolux/bake/bake.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// Ranges of isovalues, rising, which hold about as many of the sites that `request` puts at texels each and all of
/// them together: `count` of them, or with 0 as many as leave a part a site for 64 voxels, at least
/// 65,536, but no more than 64. Where many sites
/// share an isovalue, parts that have it can be larger, and up to twice as many parts keep the others from growing. The
/// same for any number of threads.
[[nodiscard]] std::vector<ValueRange> isovalue_parts(const Volume& volume, const SiteRequest& request,
                                                     std::size_t count, const Run& run);

}  // namespace isolux
