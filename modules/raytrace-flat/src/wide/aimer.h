#pragma once

#include <isolux/core/random.h>
#include <isolux/core/sample_set.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wide/hemisphere.h"
#include "wide/site_blocks.h"

namespace isolux::wide {

/// The first rays of sites: every site's are the same net of points with its own digital shift.
class Aimer {
 public:
  /// Aims rays [first, first + rays) of each site.
  Aimer(const IndexToWorld& frame, std::uint64_t seed, std::size_t rays, std::size_t first = 0)
      : points_(first + rays), to_index_(frame), seed_(mix_bits(seed)), rays_(rays), first_(first) {}

  [[nodiscard]] std::size_t rays() const { return rays_; }
  [[nodiscard]] const ToIndex& to_index() const { return to_index_; }
  [[nodiscard]] const SobolPoints& points() const { return points_; }
  /// Sites whose rays together fill a batch.
  [[nodiscard]] std::size_t sites_per_batch() const { return std::max<std::size_t>(1, kBatch / rays_); }

  /// Appends the rays of a site to the batch. \pre room for them
  void append(const Sites& sites, std::size_t site, Rays& rays, Directions& world) const {
    append(sites, site, site, rays, world);
  }
  /// The same with random numbers keyed by `key` instead of the site's place.
  void append(const Sites& sites, std::size_t site, std::size_t key, Rays& rays, Directions& world) const {
    const std::uint64_t bits = mix_bits(seed_ + key);
    const Vec3f& p = sites.positions[site];
    const Vec3f& n = sites.normals[site];
    const Pose pose{.position = {p.x, p.y, p.z},
                    .isovalue = sites.isovalues[site],
                    .normal = {n.x, n.y, n.z},
                    .shift_u = std::uint32_t(bits),
                    .shift_v = std::uint32_t(bits >> 32)};
    aim_hemisphere(pose, points_, first_, rays_, to_index_, rays.count, rays, world);
    rays.count += rays_;
  }

 private:
  /// Enough to keep the queues full to the end, few enough to stay in the second cache.
  static constexpr std::size_t kBatch = 8192;

  SobolPoints points_;
  ToIndex to_index_;
  std::uint64_t seed_;
  std::size_t rays_;
  std::size_t first_;
};

/// A thread's arrays for a batch of rays, kept between batches.
struct Batch {
  Rays rays{0};
  Directions world{0};

  void clear(std::size_t capacity) {
    if (rays.capacity() < capacity) {
      rays = Rays(capacity);
      world = Directions(capacity);
    }
    rays.count = 0;
  }
};

}  // namespace isolux::wide
