#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/trace_counters.h>

#include <functional>

#include "wide/site_blocks.h"

namespace isolux::wide {

/// for_each_block() of as many sites as fill a batch with request.rays_per_site each (sites_per_block is set here), as
/// stage "trace"; the sum of the counters.
[[nodiscard]] TraceCounters trace_blocks(const Volume& volume, const Sites& sites, BlockRequest request, const Run& run,
                                         const std::function<void(const SiteBlock&, TraceCounters&)>& body);

}  // namespace isolux::wide
