#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>

#include <span>
#include <vector>

namespace isolux {

/// What noisy light at points of one surface is off from a smooth guess of it, with the noise taken out where the
/// points around say that it is noise: m + k (r - m), m the mean of the residuals r around, k the part of their spread
/// that their own variance does not explain (Lee, "Digital image enhancement and noise filtering by use of local
/// statistics", PAMI 1980). Around means within 1.5 grid steps and of a normal within 60 degrees.
struct FilteredResiduals {
  std::vector<float> residuals;  ///< in the order given, channel fastest
  std::vector<float> variance;   ///< of what is left of the noise and of what was smoothed away with it; one a site
};

/// `residuals`: channels a site; `variance`: of each site's residual, mean over the channels. The same bits for any
/// number of threads. \throw Cancelled
[[nodiscard]] FilteredResiduals filter_residuals(const Sites& sites, std::span<const float> residuals, int channels,
                                                 std::span<const float> variance, const Run& run);

}  // namespace isolux
