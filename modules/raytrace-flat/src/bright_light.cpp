#include "bright_light.h"

#include <isolux/core/random.h>

#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <vector>

#include "environment.h"
#include "wide/aimer.h"
#include "wide/net_mean.h"
#include "wide/trace_blocks.h"

namespace isolux {
namespace {

/// A block's sites and rays.
class BrightBlock {
 public:
  BrightBlock(const Volume& volume, const Environment& bright, std::size_t rays, std::uint64_t seed)
      : environment_(bright),
        seed_(mix_bits(seed ^ 0x427269676874)),
        to_index_(volume.lattice().frame),
        points_(rays),
        mean_(points_, rays),
        rays_(rays) {}

  void light(const wide::SiteBlock& block, SampleSet& samples, TraceCounters& counters) const {
    static thread_local wide::Batch batch;
    static thread_local std::vector<Aimed> aimed;
    batch.clear(block.sites.size() * rays_);
    aimed.clear();
    for (std::size_t place = 0; place < block.sites.size(); ++place) aim(samples.sites, block, place, batch, aimed);
    trace(block.field, block.occupancy, block.inner, wide::Question::kAnyHit, batch.rays, counters);
    static thread_local std::vector<Vec3> values;
    values.assign(block.sites.size() * rays_, Vec3(0.0));
    for (std::size_t i = 0; i < aimed.size(); ++i) {
      const bool hit = batch.rays.t[i] != wide::kEscaped;
      counters.hits += std::uint64_t(hit);
      if (!hit) values[aimed[i].value] = aimed[i].light;
    }
    for (std::size_t place = 0; place < block.sites.size(); ++place) {
      const std::uint32_t site = block.sites[place];
      const std::span<const Vec3> brought = std::span(values).subspan(place * rays_, rays_);
      if (samples.sites.normals[site] != Vec3f(0.0f)) mean_.add(mean_.moments(brought), site, samples);
    }
  }

 private:
  /// A ray of the batch.
  struct Aimed {
    std::uint32_t value;  ///< its place among those of the block's sites
    Vec3 light;           ///< that it brings if nothing is in the way
  };

  void aim(const Sites& sites, const wide::SiteBlock& block, std::size_t place, wide::Batch& batch,
           std::vector<Aimed>& aimed) const {
    const std::uint32_t site = block.sites[place];
    const std::uint64_t bits = mix_bits(seed_ + site);
    const Vec3 normal(sites.normals[site]);
    wide::Rays& rays = batch.rays;
    for (std::size_t k = 0; k < rays_; ++k) {
      const double u = double(points_.u[k] ^ std::uint32_t(bits)) * 0x1p-32;
      const double v = double(points_.v[k] ^ std::uint32_t(bits >> 32)) * 0x1p-32;
      const PreparedEnvironment::Sample drawn = environment_.sample(u, v);
      const double cosine = glm::dot(normal, drawn.towards);
      if (!(cosine > 0.0)) continue;
      aimed.push_back(
          {.value = std::uint32_t(place * rays_ + k),
           .light = environment_.radiance(drawn.towards) * (cosine * std::numbers::inv_pi / drawn.density)});
      const std::size_t at = rays.count++;
      for (int a = 0; a < 3; ++a) {
        const float* const m = to_index_.m[a];
        const Vec3& d = drawn.towards;
        rays.origin[a][at] = sites.positions[site][a];
        rays.direction[a][at] = float(double(m[0]) * d.x + double(m[1]) * d.y + double(m[2]) * d.z);
      }
      rays.isovalue[at] = sites.isovalues[site];
    }
  }

  PreparedEnvironment environment_;
  std::uint64_t seed_;
  wide::ToIndex to_index_;
  wide::SobolPoints points_;
  wide::NetMean mean_;
  std::size_t rays_;
};

}  // namespace

TraceCounters add_bright_light(const Volume& volume, OuterSide outer, const Environment& bright,
                               const TraceSettings& settings, const Run& run, SampleSet& samples) {
  const auto rays = std::size_t(settings.rays);
  const BrightBlock of_block(volume, bright, rays, run.seed);
  return wide::trace_blocks(
      volume, samples.sites, {.outer = outer, .rays_per_site = rays}, run,
      [&](const wide::SiteBlock& block, TraceCounters& counters) { of_block.light(block, samples, counters); });
}

}  // namespace isolux
