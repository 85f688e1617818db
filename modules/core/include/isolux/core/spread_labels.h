#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/vec.h>

#include <cstdint>
#include <span>

namespace isolux {

/// What a place without a label holds.
inline constexpr std::uint32_t kNoLabel = 0xFFFFFFFFu;

/// Gives every place of a grid of `size` (x fastest) that has no label that of a nearest place that has one, counted in
/// steps across faces. Nothing changes where no place has one. Cost: some 10 ns a place without label.
/// \pre labels.size() is the number of places, below 2^32 - 1
void spread_labels(const Index3& size, std::span<std::uint32_t> labels);

}  // namespace isolux
