#pragma once

#include "data_place.h"

namespace isolux::detail {

/// Numbers of IEEE 754's binary16 as floats. \pre the place's layout is of uint16. \throw as read_values
[[nodiscard]] DecodedValues read_halves(const DataPlace& place, std::uint64_t count, const ReadOptions& options,
                                        const Run& run);

}  // namespace isolux::detail
