#include "sun_light.h"

#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "light_sources.h"
#include "wide/aimer.h"
#include "wide/net_mean.h"
#include "wide/trace_blocks.h"

namespace isolux {
namespace {

/// A block's sites and rays.
class SunBlock {
 public:
  SunBlock(const Volume& volume, const SunLight& sun, std::uint32_t number, std::size_t rays, std::uint64_t seed)
      : towards_(glm::normalize(Vec3(sun.direction))),
        disc_(sun_disc(sun)),
        seed_(mix_bits(mix_bits(seed ^ 0x53756E) + number)),
        to_index_(volume.lattice().frame),
        points_(rays),
        mean_(points_, rays),
        rays_(rays) {}

  void light(const wide::SiteBlock& block, SampleSet& samples, TraceCounters& counters) const {
    static thread_local wide::Batch batch;
    static thread_local std::vector<std::uint32_t> facing;
    batch.clear(block.sites.size() * rays_);
    facing.clear();
    for (const std::uint32_t site : block.sites) {
      if (!faces(samples.sites.normals[site])) continue;
      facing.push_back(site);
      aim(samples.sites, site, batch);
    }
    if (facing.empty()) return;
    trace(block.field, block.occupancy, block.inner, wide::Question::kAnyHit, batch.rays, counters);
    for (std::size_t i = 0; i < facing.size(); ++i) add(batch, i * rays_, facing[i], samples, counters);
  }

 private:
  [[nodiscard]] bool faces(const Vec3f& normal) const {
    // The disc's edge is asin(sine) from its middle; a rounding more does no harm.
    const double sine = std::sqrt(disc_.one_minus_cosine * (2.0 - disc_.one_minus_cosine));
    return normal != Vec3f(0.0f) && glm::dot(Vec3(normal), towards_) > -sine - 1e-6;
  }

  void aim(const Sites& sites, std::size_t site, wide::Batch& batch) const {
    const std::uint64_t bits = mix_bits(seed_ + site);
    const Vec3f& p = sites.positions[site];
    const wide::Pose pose{.position = {p.x, p.y, p.z},
                          .isovalue = sites.isovalues[site],
                          .normal = {float(towards_.x), float(towards_.y), float(towards_.z)},
                          .shift_u = std::uint32_t(bits),
                          .shift_v = std::uint32_t(bits >> 32)};
    wide::aim_cone(float(disc_.one_minus_cosine), pose, points_, rays_, to_index_, batch.rays.count, batch.rays,
                   batch.world);
    batch.rays.count += rays_;
  }

  void add(const wide::Batch& batch, std::size_t first, std::uint32_t site, SampleSet& samples,
           TraceCounters& counters) const {
    static thread_local std::vector<Vec3> values;
    values.assign(rays_, Vec3(0.0));
    const Vec3 normal(samples.sites.normals[site]);
    for (std::size_t k = 0; k < rays_; ++k) {
      const std::size_t ray = first + k;
      if (batch.rays.t[ray] != wide::kEscaped) {
        ++counters.hits;
        continue;
      }
      const Vec3 towards(batch.world.axis[0][ray], batch.world.axis[1][ray], batch.world.axis[2][ray]);
      values[k] = std::max(0.0, glm::dot(normal, towards)) * std::numbers::inv_pi * disc_.weight;
    }
    mean_.add(mean_.moments(values), site, samples);
  }

  Vec3 towards_;
  SunDisc disc_;
  std::uint64_t seed_;
  wide::ToIndex to_index_;
  wide::SobolPoints points_;
  wide::NetMean mean_;
  std::size_t rays_;
};

}  // namespace

TraceCounters add_sun_light(const Volume& volume, OuterSide outer, const SunLight& sun, std::uint32_t number,
                            const TraceSettings& settings, const Run& run, SampleSet& samples) {
  const auto rays = std::size_t(settings.rays);
  const SunBlock of_block(volume, sun, number, rays, run.seed);
  return wide::trace_blocks(
      volume, samples.sites, outer, rays, run,
      [&](const wide::SiteBlock& block, TraceCounters& counters) { of_block.light(block, samples, counters); });
}

}  // namespace isolux
