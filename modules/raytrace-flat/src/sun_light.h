#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <cstdint>

#include "site_rays.h"

namespace isolux {

/// Adds what arrives straight from a sun to e of samples.sites and to its variance: settings.rays rays a site, even in
/// the sun's disc, of those that face any of it; nothing is kept of a ray. Suns of a scene are told apart by `number`.
/// \pre radiance and variance are there
[[nodiscard]] TraceCounters add_sun_light(const Volume& volume, OuterSide outer, const SunLight& sun,
                                          std::uint32_t number, const TraceSettings& settings, const Run& run,
                                          SampleSet& samples);

/// Adds the same from a few rays a site where those of all sites about it see the whole sun, whose light there is known
/// then, or none of it (find_shadow_edges()). The others take the most of 1, 2, 4, 8 or 16 times settings.rays that are
/// not more than settings.rays a site in all. All take settings.rays where sites do not tell what those about them see.
/// Says who was asked, or asks those that it is told. \pre can_spread(settings)
[[nodiscard]] TraceCounters add_sun_light_by_edges(const Volume& volume, OuterSide outer, const SunLight& sun,
                                                   std::uint32_t number, const TraceSettings& settings, const Run& run,
                                                   SampleSet& samples, SunQuestions& questions);

}  // namespace isolux
