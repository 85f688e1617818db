#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/sample_set.h>

namespace isolux {

/// \throw InvalidInput if there are no samples, or their arrays do not have one length or hold values that are not
/// finite.
void require_samples(const SampleSet& samples);
/// The same of positions and their light alone, perhaps none.
void require_placed(const SampleSet& samples);
/// How noisy the samples are: their mean variance over the mean square of their light. Those of which nobody knows the
/// variance (the largest float) are left out; infinite where that is all, 0 where there is no light. \pre
/// require_samples()
[[nodiscard]] double relative_noise(const SampleSet& samples);

/// \throw InvalidInput unless there are texels, and their axes span a volume
void require_texels(const Lattice& texels);

}  // namespace isolux
