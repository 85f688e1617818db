#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// Whether there are enough rays for a part of them to say where noise is.
[[nodiscard]] bool can_spread(const TraceSettings& settings);

/// What add_sky_light() adds, of settings.rays a site on average, spread over NetCubes, and how many rays each site
/// got. Where that gains little it is the same light, to the bit, and `rays` stays empty. \pre can_spread(settings)
[[nodiscard]] TraceCounters add_sky_light_by_noise(const Volume& volume, const Scene& scene,
                                                   const TraceSettings& settings, const Run& run, SampleSet& samples,
                                                   std::vector<std::uint32_t>& rays);

/// What add_sky_light() adds, of so many rays each.
[[nodiscard]] TraceCounters add_sky_light_of(std::span<const std::uint32_t> rays, const Volume& volume,
                                             const Scene& scene, const TraceSettings& settings, const Run& run,
                                             SampleSet& samples);

}  // namespace isolux
