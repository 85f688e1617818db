#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/vec.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/gather.h>

#include <algorithm>
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
  std::vector<std::uint64_t> hits;     ///< a bit a ray, in LinkRound::order; whole words a site
  std::vector<std::uint32_t> begins;   ///< of each site's targets, and the end
  std::vector<std::uint32_t> targets;  ///< of the rays that hit, in that order

  [[nodiscard]] std::size_t bytes() const {
    return 4 * (sites.size() + begins.size() + targets.size()) + 8 * hits.size();
  }
};

/// Rays [first, first + rays) of some sites. The order of the blocks means nothing: each site is in one of them.
struct LinkRound {
  std::size_t first = 0;
  std::size_t rays = 0;
  std::vector<std::uint32_t> order;  ///< of a site's rays, less `first`: neighbouring strata (NetMean::order)
  std::vector<LinkBlock> blocks;

  [[nodiscard]] std::size_t words() const { return (rays + 63) / 64; }
  /// Does ray order[at] of the block's site hit?
  [[nodiscard]] bool hit(const LinkBlock& block, std::size_t site, std::size_t at) const {
    return (block.hits[site * words() + at / 64] >> at % 64 & 1) != 0;
  }
  /// How many of a site's rays hit.
  [[nodiscard]] std::size_t hits(const LinkBlock& block, std::size_t site) const {
    std::size_t count = 0;
    for (std::size_t w = site * words(); w < (site + 1) * words(); ++w)
      count += std::size_t(std::popcount(block.hits[w]));
    return count;
  }
  /// How often one of two neighbouring strata hits and the other does not.
  [[nodiscard]] std::size_t changes(const LinkBlock& block, std::size_t site) const {
    std::size_t count = 0;
    for (std::size_t w = 0; w < words(); ++w) {
      const std::uint64_t bits = block.hits[site * words() + w];
      const std::uint64_t next = w + 1 < words() ? block.hits[site * words() + w + 1] : 0;
      const std::size_t pairs = std::min<std::size_t>(64, rays - 1 - 64 * w);
      const std::uint64_t counted = pairs < 64 ? (std::uint64_t(1) << pairs) - 1 : ~std::uint64_t(0);
      count += std::size_t(std::popcount((bits ^ (bits >> 1 | next << 63)) & counted));
    }
    return count;
  }
};

struct RoundRequest {
  std::size_t first = 0;
  std::size_t rays = 0;
  std::size_t all_rays = 0;  ///< GatherSettings::all_rays
  OuterSide outer = OuterSide::kLower;
  RayQuestion question = RayQuestion::kFirstHit;  ///< kAnyHit: which rays hit is kept, not where
  RayNets nets = RayNets::kIndependent;
};

/// A round of which nothing is traced yet.
[[nodiscard]] LinkRound empty_round(std::size_t first, std::size_t rays);

/// What becomes of the links of some sites that were traced together. Called from many threads, each site in one block.
using LinkSink = std::function<void(LinkBlock&& block)>;

/// Traces rays of those of the sites that `numbers` lists (all if empty). `targets` may be null where only hits are
/// asked for. `round` is empty_round() of the request.
[[nodiscard]] TraceCounters trace_links(const Volume& volume, const Sites& sites,
                                        std::span<const std::uint32_t> numbers, const LinkTargets* targets,
                                        const RoundRequest& request, const LinkRound& round, const Run& run,
                                        const LinkSink& sink);
/// The same, kept.
[[nodiscard]] LinkRound trace_round(const Volume& volume, const Sites& sites, std::span<const std::uint32_t> numbers,
                                    const LinkTargets* targets, const RoundRequest& request, const Run& run,
                                    TraceCounters& counters);

/// Marks which rays of the site at a place hit. \pre the block's hits have their size and are 0
void mark_hits(const GatheredRays& gathered, std::size_t place, const LinkRound& round, LinkBlock& block);

/// The place of a site that is left out.
inline constexpr std::uint32_t kLeftOut = ~std::uint32_t(0);

/// What add_targets() reads.
struct TargetsRead {
  std::span<const float> light;           ///< of each target
  std::span<const std::uint32_t> places;  ///< where a site's sums are, or kLeftOut; empty: at its number
  std::size_t one_of = 1;                 ///< of so many targets of a site one is read and stands for the others
};

/// Adds the sum of the light over each site's targets to its sums, `stride` values each: 1, 2, 3 or 6.
void add_targets(const LinkRound& round, std::size_t stride, const TargetsRead& read, std::span<float> sums,
                 const Run& run);

}  // namespace isolux
