#pragma once

#include <isolux/core/options.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include "path_tracer.h"

namespace isolux {

/// The options of every backend that follows paths.
struct PathOptions {
  PathLimits limits;

  void describe(OptionVisitor& option) {
    option("roulette_depth", limits.roulette_depth,
           {.min = 0, .max = 1e6, .help = "reflections before Russian roulette may end a path"});
    option("longest_path", limits.longest_path,
           {.min = 0, .max = 1e6, .help = "reflections at most, for closed pockets of albedo 1"});
  }
};

/// \throw InvalidInput, naming what is wrong
void require_usable(const Sites& sites, const TraceSettings& settings);

}  // namespace isolux
