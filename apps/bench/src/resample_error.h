#pragma once

#include <isolux/resample/resampler.h>

#include <cstdint>

#include "stats.h"
#include "suite.h"
#include "truths.h"

namespace isolux::bench {

/// Random points on level sets whose exact light is known: where resampled light is judged.
struct ProbePoints {
  std::vector<Vec3f> index;             ///< index space
  std::vector<double> e;                ///< exact
  std::vector<std::uint8_t> near_edge;  ///< 1 within one and a half cells of a jump of e
};
[[nodiscard]] ProbePoints probe_points(const Truth& truth, const Volume& volume, std::size_t count,
                                       const SuiteContext& context);

struct ResamplingResult {
  Estimate error;    ///< rms of e over all points, with its 95 % interval
  Estimate edge;     ///< over those near an edge; all zero where there is none
  Estimate smooth;   ///< over the others
  Estimate seconds;  ///< of the resampling to the cell centres: median and quartiles
};

/// Resamples to the cell centres of the volume, reads the grid the best way known (LightReader, as `isolux probe` does)
/// and compares with the exact light.
[[nodiscard]] ResamplingResult resampling_error(const ProbePoints& points, const Volume& volume,
                                                const SampleSet& samples, const Resampler& resampler,
                                                const SuiteContext& context);

/// e - truth of every sample. \pre the truth is known at all of them
[[nodiscard]] std::vector<double> errors_at_sites(const Truth& truth, const Volume& volume, const SampleSet& samples);

}  // namespace isolux::bench
