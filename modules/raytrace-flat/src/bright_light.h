#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>

namespace isolux {

/// Adds what arrives straight from an image as environment, each direction drawn as often as it is bright (Pharr, Jakob
/// & Humphreys, "Physically Based Rendering", chapter on infinite area lights), to e of samples.sites and to its
/// variance: settings.rays questions a site, but for those below its horizon. \pre the image shines; radiance and
/// variance are there
[[nodiscard]] TraceCounters add_bright_light(const Volume& volume, OuterSide outer, const Environment& bright,
                                             const TraceSettings& settings, const Run& run, SampleSet& samples);

}  // namespace isolux
