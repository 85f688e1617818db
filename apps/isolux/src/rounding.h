#pragma once

#include <isolux/core/volume.h>

#include "session.h"

namespace isolux {

/// Whether so much was lost when a file's values became floats that surfaces show it: those between the smallest and
/// the largest are few.
[[nodiscard]] bool rounded_to_few(const StoredVolume& volume);

/// Says so, and what helps. `subtracted` is ReadOptions::subtract.
void warn_of_few_values(const StoredVolume& volume, double subtracted, const Session& session);

}  // namespace isolux
