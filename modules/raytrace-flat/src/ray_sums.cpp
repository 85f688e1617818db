#include "ray_sums.h"

#include <hwy/cache_control.h>
#include <isolux/core/parallel.h>

#include <array>
#include <limits>
#include <utility>

#include "prefetch_sites.h"

namespace isolux {
namespace {

void prefetch(const SampleSet& samples, std::size_t site) {
  hwy::Prefetch(&samples.radiance[site * std::size_t(samples.channels)]);
  hwy::Prefetch(&samples.variance[site]);
}

}  // namespace

RaySums::RaySums(const Volume& volume, const Sites& sites, const Scene& scene, const TargetLight& e, const LinkAim& aim,
                 std::span<const std::uint32_t> places)
    : volume_(volume), sites_(sites), brought_(scene, e), aim_(aim), places_(places), channels_(e.channels) {
  sums_.channels = int(e.channels);
  sums_.radiance.assign(sites.isovalues.size() * channels_, 0.0f);
  sums_.variance.assign(sites.isovalues.size(), 0.0f);
}

wide::Aimer RaySums::aimer(const LinkRound& round) const {
  const RayNets nets = brought_.wants_directions() ? aim_.nets : RayNets::kIndependent;
  return {volume_.lattice().frame,
          aim_.seed,
          {.first = round.first, .count = round.rays, .all = aim_.all_rays},
          nets,
          sites_};
}

void RaySums::add(const LinkRound& round, const Run& run) {
  const wide::Aimer towards = aimer(round);
  parallel_blocks(round.blocks.size(), kBlocksATask, run, "", [&](const Block& task) {
    for (std::size_t b = task.begin; b < task.end; ++b) add(round, towards, round.blocks[b]);
  });
}

void RaySums::add(const LinkRound& round, const wide::Aimer& aimer, const LinkBlock& block) {
  RayValues::Scratch scratch(round.rays);
  static thread_local wide::Batch batch;
  batch.clear(round.rays);
  for (std::size_t place = 0; place < block.sites.size(); ++place) {
    if (places_.empty() && place + kSitesAhead < block.sites.size()) {
      if (brought_.wants_directions()) {
        prefetch(sites_, block.sites[place + kSitesAhead]);
      } else {
        hwy::Prefetch(&sites_.isovalues[block.sites[place + kSitesAhead]]);
      }
      prefetch(sums_, block.sites[place + kSitesAhead]);
    }
    const std::size_t site = block.sites[place];
    if (!places_.empty() && places_[site] == kLeftOut) continue;
    auto known = brought_.known_moments(round, block, place, sites_.isovalues[site]);
    if (!known) {
      // The directions are a function of seed and site: they are made again, not kept.
      batch.rays.count = 0;
      if (brought_.wants_directions()) aimer.append(sites_, site, batch.rays, batch.world);
      const auto& world = batch.world.axis;
      const std::array<const float*, 3> towards{world[0].data(), world[1].data(), world[2].data()};
      known = brought_.moments(round, block, place, sites_.isovalues[site], towards, scratch);
    }
    const wide::NetMean::Moments& moments = *known;
    for (std::size_t c = 0; c < channels_; ++c) {
      sums_.radiance[site * channels_ + c] += float(moments.sum[int(c)]);
      sums_.variance[site] += float(moments.differences[int(c)] / double(channels_));
    }
  }
}

SampleSet RaySums::means(const RayCounts& rays, const SampleSet& lamps) {
  SampleSet samples = std::exchange(sums_, {});
  const bool no_lamps = lamps.radiance.empty();
  for (std::size_t site = 0; site < samples.variance.size(); ++site) {
    const auto n = float(rays.of(site));
    const bool is_lit = sites_.normals.empty() || sites_.normals[site] != Vec3f(0.0f);
    for (std::size_t c = 0; c < channels_; ++c) {
      float& value = samples.radiance[site * channels_ + c];
      value = is_lit ? value / n + (no_lamps ? 0.0f : lamps.radiance[site * channels_ + c]) : 0.0f;
    }
    float& variance = samples.variance[site];
    variance = is_lit && n > 1.0f ? variance / (2.0f * (n - 1.0f) * n) + (no_lamps ? 0.0f : lamps.variance[site])
                                  : std::numeric_limits<float>::max();
  }
  return samples;
}

}  // namespace isolux
