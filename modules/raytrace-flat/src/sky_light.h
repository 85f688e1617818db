#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>

namespace isolux {

/// Adds what rays bring without reflections, light of the environment and what they hit shines, to e of samples.sites
/// and to its variance: one question a ray, and nothing kept of it; no question where there is no light at all.
/// \pre radiance and variance are there
[[nodiscard]] TraceCounters add_sky_light(const Volume& volume, const Scene& scene, const TraceSettings& settings,
                                          const Run& run, SampleSet& samples);

}  // namespace isolux
