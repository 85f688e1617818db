#pragma once

#include <cstdint>

namespace isolux {

/// What the work was, for reports and benchmarks.
struct TraceCounters {
  std::uint64_t rays = 0;  ///< rays that were traced, shadow rays and bounces included
  std::uint64_t hits = 0;
  std::uint64_t macrocells = 0;  ///< entered
  std::uint64_t cells = 0;       ///< tested
  std::uint64_t cubics = 0;      ///< solved
  std::uint64_t proven = 0;      ///< hits told without following the ray: it is seen on the inner side further on
  std::uint64_t known = 0;       ///< rays to suns that were not traced: those of the sites about told
  std::uint64_t cut = 0;  ///< paths that went on beyond the most reflections: what they would have met is missing
};

inline void add(TraceCounters& sum, const TraceCounters& part) {
  sum.rays += part.rays;
  sum.hits += part.hits;
  sum.macrocells += part.macrocells;
  sum.cells += part.cells;
  sum.cubics += part.cubics;
  sum.proven += part.proven;
  sum.known += part.known;
  sum.cut += part.cut;
}

inline TraceCounters operator-(TraceCounters all, const TraceCounters& part) {
  all.rays -= part.rays;
  all.hits -= part.hits;
  all.macrocells -= part.macrocells;
  all.cells -= part.cells;
  all.cubics -= part.cubics;
  all.proven -= part.proven;
  all.known -= part.known;
  all.cut -= part.cut;
  return all;
}

}  // namespace isolux
