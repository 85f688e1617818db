#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/vec.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/gather.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "link_targets.h"

namespace isolux {

/// Blocks of links a task of a sweep takes.
inline constexpr std::size_t kBlocksATask = 4;

/// The links of some sites that were traced together, in the order of tracing: sites of like isovalue that lie close
/// together, whose ends do so too.
struct LinkBlock {
  std::vector<std::uint32_t> sites;
  std::vector<std::uint64_t> hits;     ///< a bit a ray; whole words a site
  std::vector<std::uint32_t> begins;   ///< of each site's targets, and the end
  std::vector<std::uint32_t> targets;  ///< of the rays that hit, in their order

  [[nodiscard]] std::size_t bytes() const {
    return 4 * (sites.size() + begins.size() + targets.size()) + 8 * hits.size();
  }
};

/// Rays [first, first + rays) of some sites. The order of the blocks means nothing: each site is in one of them.
struct LinkRound {
  std::size_t first = 0;
  std::size_t rays = 0;
  std::vector<LinkBlock> blocks;

  [[nodiscard]] std::size_t words() const { return (rays + 63) / 64; }
  [[nodiscard]] bool hit(const LinkBlock& block, std::size_t site, std::size_t ray) const {
    return (block.hits[site * words() + ray / 64] >> ray % 64 & 1) != 0;
  }
  /// How many of a site's rays hit.
  [[nodiscard]] std::size_t hits(const LinkBlock& block, std::size_t site) const {
    std::size_t count = 0;
    for (std::size_t w = site * words(); w < (site + 1) * words(); ++w)
      count += std::size_t(std::popcount(block.hits[w]));
    return count;
  }
};

struct RoundRequest {
  std::size_t first = 0;
  std::size_t rays = 0;
  OuterSide outer = OuterSide::kLower;
  RayQuestion question = RayQuestion::kFirstHit;  ///< kAnyHit: which rays hit is kept, not where
};

/// Traces rays of those of the sites that `numbers` lists (all if empty). `targets` may be null where only hits are
/// asked for.
[[nodiscard]] LinkRound trace_round(const Volume& volume, const Sites& sites, std::span<const std::uint32_t> numbers,
                                    const LinkTargets* targets, const RoundRequest& request, const Run& run,
                                    TraceCounters& counters);

/// sums[site] += the sum of `light` over the site's targets, `channels` values each.
void add_targets(const LinkRound& round, int channels, std::span<const float> light, std::span<float> sums,
                 const Run& run);

}  // namespace isolux
