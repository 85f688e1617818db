#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

namespace isolux {

/// The samples with their rays' noise taken out where the samples around say that it is noise: m + k (e - m), m a
/// linear function of place and isovalue fitted to the nearest samples of like normals, k the part of their spread
/// about their own m that their variance does not explain (Lee, "Digital image enhancement and noise filtering by use
/// of local statistics", PAMI 1980). Shadow edges and thin walls spread far more than noise does, and stay. The same
/// bits for any number of threads. Cost: two searches of the nearest samples each. \throw InvalidInput as resample()
/// does; Cancelled
[[nodiscard]] SampleSet denoised(const Volume& volume, const SampleSet& samples, const Run& run);

}  // namespace isolux
