#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <cstdint>

namespace isolux {

/// Adds what arrives straight from a sun to e of samples.sites and to its variance: settings.rays questions a site,
/// even in the sun's disc, of those that face any of it; nothing is kept of a ray. Suns of a scene are told apart by
/// `number`. \pre radiance and variance are there
[[nodiscard]] TraceCounters add_sun_light(const Volume& volume, OuterSide outer, const SunLight& sun,
                                          std::uint32_t number, const TraceSettings& settings, const Run& run,
                                          SampleSet& samples);

}  // namespace isolux
