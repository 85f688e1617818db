#pragma once

#include <isolux/volume_io/volume_reader.h>

#include <string>

#include "scalars.h"

namespace isolux::detail {

/// \throw InvalidInput naming `path` unless the origin is finite and the axes are finite, not zero and span a volume
void require_frame(const std::string& path, const IndexToWorld& frame);

/// A volume of values read by `options`, with ReadOptions::spacing in place of the file's, and a remark where no
/// value was ReadOptions::nodata. \throw InvalidInput for a
/// spacing that is not positive and finite, or for a frame as require_frame
[[nodiscard]] StoredVolume make_volume(const std::string& name, Lattice lattice, DecodedValues values,
                                       ScalarType stored, std::string space, const ReadOptions& options);

}  // namespace isolux::detail
