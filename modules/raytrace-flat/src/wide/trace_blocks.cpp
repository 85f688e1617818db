#include "wide/trace_blocks.h"

#include <mutex>

#include "wide/aimer.h"

namespace isolux::wide {

TraceCounters trace_blocks(const Volume& volume, const Sites& sites, BlockRequest request, const Run& run,
                           const std::function<void(const SiteBlock&, TraceCounters&)>& body) {
  request.sites_per_block = sites_per_batch(request.rays_per_site);
  TraceCounters total;
  std::mutex adding;
  for_each_block(volume, sites, request, run, "trace", [&](const SiteBlock& block) {
    TraceCounters counters;
    body(block, counters);
    const std::scoped_lock lock(adding);
    add(total, counters);
  });
  return total;
}

}  // namespace isolux::wide
