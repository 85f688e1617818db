#pragma once

#include <isolux/core/sample_set.h>

namespace isolux {

/// \throw InvalidInput if there are no samples, or their arrays do not have one length or hold values that are not
/// finite.
void require_samples(const SampleSet& samples);

}  // namespace isolux
