#pragma once

#include <isolux/core/run.h>

#include "shepard.h"

namespace isolux {

/// `options` with the number of neighbours and the exponent that were left open (kFromSamples). Those are taken that
/// foretell samples best from the others (leave-one-out cross-validation; Wahba & Wold, "A completely automatic French
/// curve", 1975): few and near ones where samples are exact, many alike where they are noise. Cost: a thousand
/// searches.
[[nodiscard]] ShepardOptions chosen_by_samples(ShepardOptions options, const Volume& volume, const SampleSet& samples,
                                               const Run& run);

}  // namespace isolux
