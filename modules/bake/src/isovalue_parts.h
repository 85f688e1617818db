#pragma once

#include <isolux/bake/bake.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// Ranges of isovalues, rising, which hold about as many texels each and together all of those `wanted` (or of any):
/// at most `count` of them, fewer where many texels have one isovalue. The same for any number of threads.
[[nodiscard]] std::vector<ValueRange> isovalue_parts(const Volume& volume, const Lattice& texels,
                                                     const std::optional<ValueRange>& wanted, std::size_t count);

}  // namespace isolux
