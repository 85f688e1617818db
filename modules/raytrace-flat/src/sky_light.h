#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <cstdint>
#include <span>

namespace isolux {

/// Which rays of which sites are traced.
struct SkyRays {
  int first = 0;
  int count = 0;
  int all = 0;                            ///< of the net they are a part of
  double share = 1.0;                     ///< of a site's light that is to come of them
  std::span<const std::uint32_t> only{};  ///< numbers of sites; empty: all
};

/// Adds what rays bring without reflections, light of the environment and what they hit shines, to e of samples.sites
/// and to its variance: one question a ray, and nothing kept of it; no question where there is no light at all.
/// \pre radiance and variance are there
[[nodiscard]] TraceCounters add_sky_light(const Volume& volume, const Scene& scene, const TraceSettings& settings,
                                          const SkyRays& rays, const Run& run, SampleSet& samples);

}  // namespace isolux
