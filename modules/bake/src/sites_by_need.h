#pragma once

#include <isolux/bake/bake.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <cstddef>

namespace isolux {

/// About `count` of the candidates, more of them where light changes within a cell of the volume: a candidate is kept
/// with a probability that grows as the spread of the first samples in its cell and those around, less their rays'
/// noise (Neyman, "On the two different aspects of the representative method", 1934). Keyed by run.seed; the same for
/// any number of threads. \throw Cancelled
[[nodiscard]] Sites sites_by_need(const Volume& volume, const SampleSet& first, const Sites& candidates,
                                  std::size_t count, const Run& run);

/// Appends samples of the same number of channels.
void append_samples(SampleSet& all, const SampleSet& more);

/// bake() with scattered sites, half of them evenly and the other half where those say that light changes. \throw
/// InvalidInput if an error or a time is asked for
[[nodiscard]] BakeResult bake_scattered_by_need(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                                                const Stages& stages, const Run& run);

}  // namespace isolux
