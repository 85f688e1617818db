#pragma once

#include "figures.h"
#include "suite.h"

namespace isolux::bench {

/// What an index of the volume is for: sweeps of the isovalue through a dense field, and small surfaces in large
/// volumes; with and without it, beside VTK's Flying Edges. Milliseconds an isovalue.
[[nodiscard]] Table extract_many(const SuiteContext& context);

}  // namespace isolux::bench
