#pragma once

#include <hwy/cache_control.h>
#include <isolux/core/sample_set.h>

#include <cstddef>

namespace isolux {

/// Sites that are traced together lie far apart in memory: how many early they are asked for.
inline constexpr std::size_t kSitesAhead = 8;

inline void prefetch(const Sites& sites, std::size_t site) {
  hwy::Prefetch(&sites.positions[site]);
  hwy::Prefetch(&sites.isovalues[site]);
  hwy::Prefetch(&sites.normals[site]);
}

inline void prefetch_light(const SampleSet& samples, std::size_t site) {
  hwy::Prefetch(&samples.radiance[site * std::size_t(samples.channels)]);
  hwy::Prefetch(&samples.variance[site]);
}

}  // namespace isolux
