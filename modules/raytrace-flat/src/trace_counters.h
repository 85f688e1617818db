#pragma once

#include <isolux/raytrace_flat/flat_tracer.h>

namespace isolux {

inline void add(TraceCounters& sum, const TraceCounters& part) {
  sum.rays += part.rays;
  sum.hits += part.hits;
  sum.macrocells += part.macrocells;
  sum.cells += part.cells;
  sum.cubics += part.cubics;
  sum.proven += part.proven;
}

inline TraceCounters operator-(TraceCounters all, const TraceCounters& part) {
  all.rays -= part.rays;
  all.hits -= part.hits;
  all.macrocells -= part.macrocells;
  all.cells -= part.cells;
  all.cubics -= part.cubics;
  all.proven -= part.proven;
  return all;
}

}  // namespace isolux
