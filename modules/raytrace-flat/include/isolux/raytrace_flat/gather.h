#pragma once

#include <isolux/core/field.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>

namespace isolux {

/// What a gather wants to know of each ray.
enum class RayQuestion : std::uint8_t {
  kAnyHit,   ///< whether it meets its level set; distances of hits are then 0
  kFirstHit  ///< where it does first
};

struct GatherSettings {
  int rays = 64;  ///< a site
  OuterSide outer = OuterSide::kLower;
  RayQuestion question = RayQuestion::kFirstHit;
  int all_rays = 0;                       ///< that a site will have had by and by; 0: no more than these
  int first_ray = 0;                      ///< rays [first_ray, first_ray + rays) of each site's sequence
  std::span<const std::uint32_t> only{};  ///< numbers of the sites that are asked, each once; empty: all of them
  RayNets nets = RayNets::kIndependent;
  std::optional<ValueRange> values{};  ///< of the volume, where known: saves a pass
};

/// The rays of some sites and what they met, as a gather hands them over. Ray k of sites[i] is number i * rays + k of
/// every array. The arrays die with the call that passes them.
struct GatheredRays {
  /// The distance of rays that leave the box.
  static constexpr float kEscaped = std::numeric_limits<float>::infinity();

  std::span<const std::uint32_t> sites;       ///< numbers of the sites
  std::size_t rays = 0;                       ///< a site
  std::span<const float> direction[3];        ///< world space, unit; cosine-distributed about the site's normal
  std::span<const float> index_direction[3];  ///< index space; origin + index_distance * this is the hit
  std::span<const float> index_distance;      ///< in lengths of index_direction; 0 if blocked at the site itself
  float world_scale = 1.0f;                   ///< times index_distance: world units

  [[nodiscard]] bool escaped(std::size_t ray) const { return index_distance[ray] == kEscaped; }
};

/// Called from many threads, once for each site asked in all.
using RaySink = std::function<void(const GatheredRays&)>;

/// Traces settings.rays hemisphere rays from each site asked over the site's own level set, through the wide kernels:
/// the one way in which whole sets of sites are traced fast. Directions are the points of a (0,m,2)-net with a random
/// digital shift for each site, keyed by run.seed and the site's number: they do not depend on threads, other sites, or
/// what the volume holds. Which sites arrive together does not depend on threads either. \pre require_usable(volume);
/// sites inside its box with unit normals (sites of normal zero are given to the sink with directions that mean
/// nothing). Interleaved, a site's shift also follows from its place among all sites, and there is a first_ray only
/// where all_rays says of which net these are a part. \throw Cancelled; InvalidInput for volumes of 2^31 voxels or
/// more, rays < 1, numbers that no site has, or sites whose arrays have several lengths
[[nodiscard]] TraceCounters gather(const Volume& volume, const Sites& sites, const GatherSettings& settings,
                                   const Run& run, const RaySink& sink);

}  // namespace isolux
