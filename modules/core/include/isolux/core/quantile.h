#pragma once

#include <span>

namespace isolux {

/// The value that `part` (0 to 1) of `values` do not exceed, 0 of none: of many values, that of 65,536 drawn evenly
/// from them. What a few wild values cannot move.
[[nodiscard]] float quantile(std::span<const float> values, double part);

}  // namespace isolux
