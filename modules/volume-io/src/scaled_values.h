#pragma once

#include "scalars.h"

namespace isolux::detail {

struct Scaling {
  double slope = 1.0;
  double intercept = 0.0;
};

/// Reads `count` numbers x as the floats nearest to slope * x + intercept less ReadOptions::subtract, and those of
/// ReadOptions::nodata as NaN, worked out in double: what an integer beyond
/// 2^24 has in its last bits is still there when an offset is taken off. \throw InvalidInput for a result that does not
/// fit a float; IoError naming `path` if there are fewer numbers; Cancelled
[[nodiscard]] DecodedValues decode_scaled(ByteSource& source, const ScalarLayout& layout, std::uint64_t count,
                                          const Scaling& scaling, const ReadOptions& options, const std::string& path,
                                          const Run& run);

}  // namespace isolux::detail
