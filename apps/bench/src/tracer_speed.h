#pragma once

#include <isolux/raytrace_flat/flat_tracer.h>

#include <cstddef>
#include <string>
#include <vector>

#include "stats.h"
#include "suite.h"

namespace isolux::bench {

inline constexpr int kSpeedRays = 64;  ///< a site

struct TracerSpeed {
  Estimate mrays;              ///< million rays a second once set up: median and quartiles
  double setup_seconds = 0.0;  ///< what a volume costs before the first ray
  TraceCounters counters;
};

/// A tracer's speed on the ray population of flattened lighting: sites uniform in the volume and as dense as in a bake
/// of one a cell, cosine rays over their hemispheres, no bounces. Takes about `seconds`: where a whole bake would not
/// fit, only the isovalues nearest to `isovalue` are lit, a few repetitions.
[[nodiscard]] TracerSpeed tracer_speed(const std::string& tracer, const Volume& volume, float isovalue, const Run& run,
                                       double seconds, const SuiteContext& context);

/// The same for gather() asked where rays hit first, which is what bounces take.
[[nodiscard]] TracerSpeed first_hit_speed(const Volume& volume, float isovalue, const Run& run, double seconds,
                                          const SuiteContext& context);

/// A number of items that takes about `wanted` seconds where `items` took `seconds`.
[[nodiscard]] std::size_t grown(std::size_t items, double seconds, double wanted);

/// Names of the tracers of this build.
[[nodiscard]] std::vector<std::string> tracer_names(const SuiteContext& context);
/// The one that is used unless another is named.
[[nodiscard]] std::string default_tracer(const SuiteContext& context);

}  // namespace isolux::bench
