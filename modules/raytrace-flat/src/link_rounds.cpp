#include "link_rounds.h"

#include <hwy/cache_control.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/raytrace_flat/trace_counters.h>

#include <mutex>
#include <utility>

#include "wide/net_mean.h"

namespace isolux {
namespace {

/// Sites of a block lie far apart in memory: how many early they are asked for.
constexpr std::size_t kTargetsAhead = 16;
/// Of a site, that say enough of the others.
constexpr std::size_t kFewTargets = 2;

/// Adds the light of one site's targets. Two sums at once hide half of the additions' latency.
template <int stride>
void add_all(std::span<const std::uint32_t> targets, const float* light, float* sum) {
  float even[stride] = {};
  float odd[stride] = {};
  std::size_t i = 0;
  for (; i + 1 < targets.size(); i += 2) {
    for (int c = 0; c < stride; ++c) {
      even[c] += light[std::size_t(targets[i]) * stride + std::size_t(c)];
      odd[c] += light[std::size_t(targets[i + 1]) * stride + std::size_t(c)];
    }
  }
  for (int c = 0; c < stride; ++c) {
    if (i < targets.size()) even[c] += light[std::size_t(targets[i]) * stride + std::size_t(c)];
    sum[c] += even[c] + odd[c];
  }
}

/// The same of one of `one_of` targets, which stand for the others. Targets lie in the order of the net's strata.
template <int stride>
void add_some(std::span<const std::uint32_t> targets, std::size_t first, std::size_t one_of, const float* light,
              float* sum) {
  float some[stride] = {};
  std::size_t count = 0;
  for (std::size_t i = first; i < targets.size(); i += one_of, ++count)
    for (int c = 0; c < stride; ++c) some[c] += light[std::size_t(targets[i]) * stride + std::size_t(c)];
  const float scale = float(targets.size()) / float(count);
  for (int c = 0; c < stride; ++c) sum[c] += some[c] * scale;
}

template <int stride>
void add_block(const LinkBlock& block, const TargetsRead& read, std::span<float> sums) {
  const auto [light, places, one_of] = read;
  for (std::size_t s = 0; s < block.sites.size(); ++s) {
    std::size_t place = block.sites[s];
    if (places.empty()) {
      if (s + kTargetsAhead < block.sites.size())
        hwy::Prefetch(&sums[std::size_t(block.sites[s + kTargetsAhead]) * stride]);
    } else {
      if (s + kTargetsAhead < block.sites.size()) hwy::Prefetch(&places[block.sites[s + kTargetsAhead]]);
      if (places[place] == kLeftOut) continue;
      place = places[place];
    }
    const std::size_t begin = block.begins[s];
    const std::span targets(block.targets.data() + begin, block.begins[s + 1] - begin);
    if (targets.size() < kFewTargets * one_of || one_of == 1)
      add_all<stride>(targets, light.data(), &sums[place * stride]);
    else
      add_some<stride>(targets, mix_bits(block.sites[s]) % one_of, one_of, light.data(), &sums[place * stride]);
  }
}

/// The links of what a gather hands over.
class BlockMaker {
 public:
  BlockMaker(const Sites& sites, const LinkTargets* targets, RayQuestion question, const LinkRound& round,
             std::uint64_t seed)
      : sites_(sites), targets_(targets), question_(question), round_(round), seed_(seed) {}

  [[nodiscard]] LinkBlock make(const GatheredRays& gathered) const {
    // Kept from block to block: growing each block's own would leave holes of its size in memory.
    static thread_local std::vector<std::uint32_t> found;
    found.clear();
    LinkBlock block;
    block.hits.assign(gathered.sites.size() * round_.words(), 0);
    block.sites.reserve(gathered.sites.size());
    block.begins.reserve(gathered.sites.size() + 1);
    for (std::size_t place = 0; place < gathered.sites.size(); ++place) {
      const std::uint32_t site = gathered.sites[place];
      block.sites.push_back(site);
      block.begins.push_back(std::uint32_t(found.size()));
      if (sites_.normals[site] == Vec3f(0.0f)) continue;
      mark_hits(gathered, place, round_, block);
      if (question_ == RayQuestion::kFirstHit) append_targets(gathered, place, block, found);
    }
    block.begins.push_back(std::uint32_t(found.size()));
    block.targets.assign(found.begin(), found.end());
    return block;
  }

 private:
  void append_targets(const GatheredRays& gathered, std::size_t place, const LinkBlock& block,
                      std::vector<std::uint32_t>& targets) const {
    static thread_local std::vector<LinkTargets::End> ends;
    ends.clear();
    const std::uint32_t site = block.sites[place];
    const Vec3f origin(sites_.positions[site]);
    for (std::size_t at = 0; at < round_.rays; ++at) {
      if (!round_.hit(block, place, at)) continue;
      const std::size_t k = round_.order[at];
      const std::size_t i = place * round_.rays + k;
      const Vec3f direction(gathered.index_direction[0][i], gathered.index_direction[1][i],
                            gathered.index_direction[2][i]);
      ends.push_back(
          {.index = origin + gathered.index_distance[i] * direction, .ray = std::uint32_t(round_.first + k)});
    }
    targets_->append_targets(ends, origin, sites_.isovalues[site], LinkTargets::draws_of(seed_, site), targets);
  }

  const Sites& sites_;
  const LinkTargets* targets_;
  RayQuestion question_;
  const LinkRound& round_;
  std::uint64_t seed_;
};

}  // namespace

LinkRound empty_round(std::size_t first, std::size_t rays) {
  const wide::NetMean mean(wide::SobolPoints(first + rays), rays, first);
  return {.first = first, .rays = rays, .order = mean.order(), .blocks = {}};
}

TraceCounters trace_links(const Volume& volume, const Sites& sites, std::span<const std::uint32_t> numbers,
                          const LinkTargets* targets, const RoundRequest& request, const LinkRound& round,
                          const Run& run, const LinkSink& sink) {
  const GatherSettings settings{.rays = int(request.rays),
                                .outer = request.outer,
                                .question = request.question,
                                .all_rays = int(request.all_rays),
                                .first_ray = int(request.first),
                                .only = numbers,
                                .nets = request.nets};
  const BlockMaker maker(sites, targets, request.question, round, run.seed);
  return gather(volume, sites, settings, run, [&](const GatheredRays& gathered) { sink(maker.make(gathered)); });
}

LinkRound trace_round(const Volume& volume, const Sites& sites, std::span<const std::uint32_t> numbers,
                      const LinkTargets* targets, const RoundRequest& request, const Run& run,
                      TraceCounters& counters) {
  LinkRound round = empty_round(request.first, request.rays);
  std::mutex adding;
  add(counters, trace_links(volume, sites, numbers, targets, request, round, run, [&](LinkBlock&& block) {
        const std::scoped_lock lock(adding);
        round.blocks.push_back(std::move(block));
      }));
  return round;
}

void mark_hits(const GatheredRays& gathered, std::size_t place, const LinkRound& round, LinkBlock& block) {
  std::uint64_t* const hits = &block.hits[place * round.words()];
  const float* const distance = &gathered.index_distance[place * round.rays];
  for (std::size_t first = 0; first < round.rays; first += 64) {
    std::uint64_t word = 0;
    const std::size_t last = std::min(first + 64, round.rays);
    for (std::size_t at = first; at < last; ++at)
      word |= std::uint64_t(distance[round.order[at]] != GatheredRays::kEscaped) << (at - first);
    hits[first / 64] = word;
  }
}

void add_targets(const LinkRound& round, std::size_t stride, const TargetsRead& read, std::span<float> sums,
                 const Run& run) {
  const auto add = stride == 1 ? add_block<1> : stride == 2 ? add_block<2> : stride == 3 ? add_block<3> : add_block<6>;
  parallel_blocks(round.blocks.size(), kBlocksATask, run, "", [&](const Block& task) {
    for (std::size_t b = task.begin; b < task.end; ++b) add(round.blocks[b], read, sums);
  });
}

}  // namespace isolux
