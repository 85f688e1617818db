#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/sample_set.h>

namespace isolux {

/// \throw InvalidInput if there are no samples, or their arrays do not have one length or hold values that are not
/// finite.
void require_samples(const SampleSet& samples);
/// The same of positions and their light alone, perhaps none.
void require_placed(const SampleSet& samples);
/// \throw InvalidInput unless there are texels, and their axes span a volume
void require_texels(const Lattice& texels);

}  // namespace isolux
