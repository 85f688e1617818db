#pragma once

#include <isolux/raytrace_flat/flat_tracer.h>

#include <vector>

#include "environment.h"
#include "light_sources.h"
#include "path_sampler.h"
#include "ray_march.h"

namespace isolux {

/// When paths end that nothing else ends.
struct PathLimits {
  int roulette_depth = 3;   ///< reflections before Russian roulette may end a path
  int longest_path = 1000;  ///< reflections at most
};

/// Paths over one level set, from a site through diffuse reflections to the environment, with next-event estimation
/// towards light sources at every vertex (Veach, "Robust Monte Carlo methods for light transport simulation", 1997).
/// Immutable; volume and scene must outlive it.
class PathTracer {
 public:
  PathTracer(const Volume& volume, const Scene& scene, const TraceSettings& settings, const PathLimits& limits);

  /// e as one path of a site sees it, an unbiased estimate; `first` gets the two numbers that chose its first
  /// direction.
  [[nodiscard]] Vec3 radiance(const Vec3& origin, const Vec3& normal, float isovalue, const PathSampler& numbers,
                              std::uint32_t path, UnitPair& first, TraceCounters& counters) const;

 private:
  /// Where a path stands.
  struct Vertex {
    Vec3 position;  ///< index space
    Vec3 normal;    ///< world space
    Frame frame;
    float isovalue;
  };
  [[nodiscard]] Vec3 direct_light(const Vertex& vertex, const PathSampler& numbers, std::uint32_t path,
                                  std::uint32_t dimension, TraceCounters& counters) const;
  [[nodiscard]] bool is_visible(const Vertex& vertex, const Vec3& towards, double distance,
                                TraceCounters& counters) const;
  /// What a cosine-distributed direction that leaves the box brings.
  [[nodiscard]] Vec3 escaped_light(const Vertex& vertex, const Vec3& towards) const;
  [[nodiscard]] Vec3 normal_at(const Vec3& position) const;

  const Scene& scene_;
  TraceSettings settings_;
  PathLimits limits_;
  RayMarch march_;
  TrilinearField field_;
  Mat3 world_to_index_;
  PreparedEnvironment environment_;
  std::vector<PreparedLight> lights_;
};

}  // namespace isolux
