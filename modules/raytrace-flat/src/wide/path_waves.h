#pragma once

#include <isolux/core/field.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <cstdint>
#include <span>
#include <vector>

#include "environment.h"
#include "light_sources.h"
#include "path_sampler.h"
#include "path_tracer.h"
#include "wide/aimer.h"
#include "wide/net_mean.h"
#include "wide/site_blocks.h"

namespace isolux::wide {

/// Path tracing wave by wave: all paths of a block of sites take their first step together, then all that are left
/// their second, each wave one batch of the wide kernels. Estimates what PathTracer does, by the same rules. Immutable;
/// volume and scene must outlive it.
class PathWaves {
 public:
  PathWaves(const Volume& volume, const Scene& scene, const TraceSettings& settings, const PathLimits& limits,
            std::uint64_t seed, const Sites& sites);

  [[nodiscard]] const Aimer& aimer() const { return aimer_; }
  /// Whether so many paths may be cut off that it matters: with lower albedos than .98 one of 5e8 goes on.
  [[nodiscard]] bool cuts_paths() const;
  /// Lights the sites of a block: radiance and variance of `samples`. Those of `lamps`, if there are any, get what
  /// comes straight from the light sources alone. `cut`, unless it is empty, gets how many of each site's paths are cut
  /// off.
  void light(const SiteBlock& block, SampleSet& samples, SampleSet* lamps, std::span<std::uint32_t> cut,
             TraceCounters& counters) const;

 private:
  /// What all vertices of a site's paths share: they lie on one level set.
  struct Material {
    Vec3 albedo;
    Vec3 emission;
    bool is_black;  ///< reflects nothing
  };
  /// A path and where it stands.
  struct Path {
    std::uint32_t ray;  ///< of the first wave: which value it adds to
    Vec3 throughput;
    Vec3f position;  ///< index space
    float isovalue;
    Vec3 normal;  ///< world space
  };
  struct Wave;

  void start(const SiteBlock& block, const Sites& sites, Wave& wave) const;
  void aim(Wave& wave) const;
  /// True if no ray of this wave can bring light: light sources were asked apart.
  [[nodiscard]] bool is_dark(const Wave& wave) const;
  void arrive(const SiteBlock& block, Wave& wave) const;
  /// Counts the paths that would go on but for the limit. \pre this wave is the last for it; arrive() has not been
  void count_cut(const Wave& wave, std::span<std::uint32_t> cut, TraceCounters& counters) const;
  /// Moves a path to the vertex that its ray has hit; false if it ends there.
  [[nodiscard]] bool go_on(const SiteBlock& block, const Wave& wave, std::size_t ray, Path& path) const;
  void direct_light(const SiteBlock& block, Wave& wave, TraceCounters& counters) const;
  /// Traces one light sample a path (density 0: none) and adds what arrives.
  struct Sighting;
  void look(const SiteBlock& block, Wave& wave, std::vector<Sighting>& sightings, TraceCounters& counters) const;
  [[nodiscard]] Vec3 escaped_light(const Vec3& normal, const Vec3& towards) const;
  [[nodiscard]] UnitPair numbers(const Wave& wave, const Path& path, std::uint32_t dimension) const;

  const Scene& scene_;
  TraceSettings settings_;
  PathLimits limits_;
  std::uint64_t seed_;
  TrilinearField field_;
  PreparedEnvironment environment_;
  std::vector<PreparedLight> lights_;
  Aimer aimer_;
  NetMean mean_;
};

}  // namespace isolux::wide
