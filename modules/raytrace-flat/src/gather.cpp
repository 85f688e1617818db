#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat/gather.h>

#include <algorithm>
#include <cstdint>
#include <mutex>

#include "prefetch_sites.h"
#include "wide/aimer.h"
#include "wide/rays.h"
#include "wide/site_blocks.h"

namespace isolux {

static_assert(GatheredRays::kEscaped == wide::kEscaped);

TraceCounters gather(const Volume& volume, const Sites& sites, const GatherSettings& settings, const Run& run,
                     const RaySink& sink) {
  require_equal_lengths(sites);
  if (settings.rays < 1) throw InvalidInput(fmt::format("rays = {}: allowed is 1 and more", settings.rays));
  if (settings.first_ray < 0)
    throw InvalidInput(fmt::format("first_ray = {}: allowed is 0 and more", settings.first_ray));
  for (const std::uint32_t site : settings.only)
    if (site >= sites.size()) throw InvalidInput(fmt::format("site {} of {}", site, sites.size()));
  const auto last = std::int64_t(settings.first_ray) + settings.rays;
  if (settings.nets == RayNets::kInterleaved && settings.first_ray > 0 && last > settings.all_rays)
    throw InvalidInput("interleaved nets go from the first ray on or in parts of all_rays");
  const wide::RayRange range{.first = std::size_t(settings.first_ray),
                             .count = std::size_t(settings.rays),
                             .all = std::size_t(std::max(settings.all_rays, 0))};
  const wide::Aimer aimer(volume.lattice().frame, run.seed, range, settings.nets, sites);
  const wide::BlockRequest request{.outer = settings.outer,
                                   .rays_per_site = aimer.rays(),
                                   .sites_per_block = wide::sites_per_batch(aimer.rays()),
                                   .proofs = settings.question == RayQuestion::kAnyHit,
                                   .values = settings.values,
                                   .only = settings.only};
  const auto question = settings.question == RayQuestion::kAnyHit ? wide::Question::kAnyHit : wide::Question::kFirstHit;
  TraceCounters total;
  std::mutex adding;
  wide::for_each_block(volume, sites, request, run, "trace", [&](const wide::SiteBlock& block) {
    static thread_local wide::Batch batch;
    batch.clear(block.sites.size() * aimer.rays());
    for (std::size_t i = 0; i < block.sites.size(); ++i) {
      if (i + kSitesAhead < block.sites.size()) prefetch(sites, block.sites[i + kSitesAhead]);
      const std::uint32_t site = block.sites[i];
      aimer.append(sites, site, batch.rays, batch.world);
    }
    TraceCounters counters;
    wide::trace(block.field, block.occupancy, block.inner, question, batch.rays, counters);
    GatheredRays gathered;
    gathered.sites = block.sites;
    gathered.rays = aimer.rays();
    gathered.world_scale = aimer.to_index().world_step;
    const std::size_t count = batch.rays.count;
    for (int a = 0; a < 3; ++a) {
      gathered.direction[a] = {batch.world.axis[a].data(), count};
      gathered.index_direction[a] = {batch.rays.direction[a].data(), count};
    }
    gathered.index_distance = {batch.rays.t.data(), count};
    std::uint32_t hits = 0;  // as wide as a float: vectorises
    for (std::size_t i = 0; i < count; ++i) hits += std::uint32_t(!gathered.escaped(i));
    counters.hits += hits;
    sink(gathered);
    const std::scoped_lock lock(adding);
    add(total, counters);
  });
  return total;
}

}  // namespace isolux
