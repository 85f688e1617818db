#pragma once

#include <isolux/bake/bake.h>

#include <span>
#include <vector>

namespace isolux {

/// Light traced at given points instead of read from a texture: exact up to the rays' noise.
struct PointLight {
  std::vector<Vec3f> radiance;  ///< e, one a point; (0,0,0) where there is no normal
  TraceCounters counters;
  double rmse_estimate = 0.0;
};

/// e at world positions, each on the level set of its own value. \throw as bake()
[[nodiscard]] PointLight light_points(const Volume& volume, const Scene& scene, std::span<const Vec3f> world_positions,
                                      const TraceSettings& settings, const BackendChoice& tracer, const Stages& stages,
                                      const Run& run);

}  // namespace isolux
