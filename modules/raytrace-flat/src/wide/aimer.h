#pragma once

#include <isolux/core/random.h>
#include <isolux/core/sample_set.h>
#include <isolux/raytrace_flat/gather.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "wide/hemisphere.h"
#include "wide/net_places.h"
#include "wide/site_blocks.h"

namespace isolux::wide {

/// Sites whose rays together fill a batch: enough to keep the queues full to the end, few enough to stay in the second
/// cache.
[[nodiscard]] inline std::size_t sites_per_batch(std::size_t rays) {
  constexpr std::size_t kBatch = 8192;
  return std::max<std::size_t>(1, kBatch / rays);
}

/// Rays [first, first + count) of those that a site has.
struct RayRange {
  std::size_t first = 0;
  std::size_t count = 0;
  std::size_t all = 0;  ///< of a site, if more than these: what interleaved nets are parted by
};

/// The first rays of sites: every site's are the same net of points with its own digital shift, independent of all
/// others or such that neighbours' rays are one net.
class Aimer {
 public:
  Aimer(const IndexToWorld& frame, std::uint64_t seed, const RayRange& range, RayNets nets, const Sites& sites)
      : points_(range.first + range.count),
        to_index_(frame),
        seed_(mix_bits(seed)),
        rays_(range.count),
        first_(range.first),
        part_bits_(int(std::bit_width(std::max(range.all, range.first + range.count) - 1))) {
    if (nets == RayNets::kInterleaved) places_.emplace(sites);
  }

  [[nodiscard]] std::size_t rays() const { return rays_; }
  [[nodiscard]] const ToIndex& to_index() const { return to_index_; }
  [[nodiscard]] const SobolPoints& points() const { return points_; }

  /// Appends the rays of a site to the batch. \pre room for them
  void append(const Sites& sites, std::size_t site, Rays& rays, Directions& world) const {
    const SobolPoint shift = shift_of(sites, site);
    const Vec3f& p = sites.positions[site];
    const Vec3f& n = sites.normals[site];
    const Pose pose{.position = {p.x, p.y, p.z},
                    .isovalue = sites.isovalues[site],
                    .normal = {n.x, n.y, n.z},
                    .shift_u = shift.u,
                    .shift_v = shift.v};
    aim_hemisphere(pose, points_, first_, rays_, to_index_, rays.count, rays, world);
    rays.count += rays_;
  }

 private:
  [[nodiscard]] SobolPoint shift_of(const Sites& sites, std::size_t site) const {
    const NetPlaces::Place place = places_ ? places_->of(sites, site) : NetPlaces::Place{.net = site, .part = 0};
    const std::uint64_t bits = mix_bits(seed_ + place.net);
    // The parts of a net are its points with the upper bits of their numbers changed, which is a digital shift.
    const SobolPoint part = sobol_point(std::uint64_t(place.part) << part_bits_);
    return {.u = std::uint32_t(bits) ^ part.u, .v = std::uint32_t(bits >> 32) ^ part.v};
  }

  SobolPoints points_;
  ToIndex to_index_;
  std::uint64_t seed_;
  std::size_t rays_;
  std::size_t first_;
  int part_bits_;                      ///< of the numbers of a site's rays
  std::optional<NetPlaces> places_{};  ///< of interleaved nets
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
