#pragma once

#include <isolux/raytrace_flat/flat_tracer.h>

namespace isolux {

inline void add(TraceCounters& sum, const TraceCounters& part) {
  sum.rays += part.rays;
  sum.hits += part.hits;
  sum.macrocells += part.macrocells;
  sum.cells += part.cells;
  sum.cubics += part.cubics;
}

}  // namespace isolux
