#pragma once

#include <isolux/resample/resampler.h>

#include "stats.h"
#include "suite.h"
#include "truths.h"

namespace isolux::bench {

struct ResamplingResult {
  Estimate error;        ///< rms of e over the texels whose exact e is known, with its 95 % interval
  double seconds = 0.0;  ///< of the resampling
  std::size_t texels = 0;
};

/// Resamples to the cell centres of the volume and compares with the truth.
[[nodiscard]] ResamplingResult resampling_error(const Truth& truth, const Volume& volume, const SampleSet& samples,
                                                const Resampler& resampler, const SuiteContext& context);

/// e - truth of every sample. \pre the truth is known at all of them
[[nodiscard]] std::vector<double> errors_at_sites(const Truth& truth, const Volume& volume, const SampleSet& samples);

}  // namespace isolux::bench
