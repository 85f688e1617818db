#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>

namespace isolux {

/// Whether e without reflections is all a matter of which rays escape and where to: no light sources, and no directions
/// that are worth drawing for the environment's sake.
[[nodiscard]] bool is_sky_light(const Scene& scene);

/// Such e of samples.sites and its variance, in samples.channels channels: one question a ray, and nothing kept of it;
/// no question where there is no light at all. \pre is_sky_light(); radiance and variance have their sizes
[[nodiscard]] TraceCounters add_sky_light(const Volume& volume, const Scene& scene, const TraceSettings& settings,
                                          const Run& run, SampleSet& samples);

}  // namespace isolux
