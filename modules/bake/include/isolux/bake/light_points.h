#pragma once

#include <isolux/bake/bake.h>
#include <isolux/resample/light_reader.h>

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

/// The same for points of one isosurface, with a light of this scene as control variate: what the rays found less what
/// the light says is smoothed over the points around, as far as it is the rays' noise, and added to what the light
/// says. Where rays are few about half of them then give the same error (docs/measured/resampling.md), at the price of
/// a bias where the light is wrong in detail. Smoothing costs some microseconds a point. \throw as bake()
[[nodiscard]] PointLight light_points(const Volume& volume, const Scene& scene, std::span<const Vec3f> world_positions,
                                      const TraceSettings& settings, const BackendChoice& tracer, const Stages& stages,
                                      const Run& run, const LightReader& light);

}  // namespace isolux
