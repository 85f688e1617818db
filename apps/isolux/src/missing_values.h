#pragma once

#include <isolux/core/volume.h>

#include <optional>

namespace isolux {

/// Voxels of the file's value `nodata` become NaN, or `replacement` where one is given. `subtracted` is what reading
/// took off every value. Whole numbers become floats unless they hold the replacement.
void mark_missing(StoredVolume& volume, double nodata, double subtracted, std::optional<float> replacement);

/// Voxels that are infinite or not a number become `replacement`.
void replace_nonfinite(StoredVolume& volume, float replacement);

}  // namespace isolux
