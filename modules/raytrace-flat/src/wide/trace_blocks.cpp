#include "wide/trace_blocks.h"

#include <mutex>

#include "wide/aimer.h"

namespace isolux::wide {

TraceCounters trace_blocks(const Volume& volume, const Sites& sites, OuterSide outer, std::size_t rays, const Run& run,
                           const std::function<void(const SiteBlock&, TraceCounters&)>& body) {
  const BlockRequest request{.outer = outer, .rays_per_site = rays, .sites_per_block = sites_per_batch(rays)};
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
