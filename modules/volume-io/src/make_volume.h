#pragma once

#include <isolux/volume_io/volume_reader.h>

#include <string>
#include <vector>

namespace isolux::detail {

/// A volume of values read, with ReadOptions::spacing in place of the file's. \throw InvalidInput for a spacing that is
/// not positive and finite
[[nodiscard]] Volume make_volume(const std::string& name, Lattice lattice, std::vector<float> values, ScalarType stored,
                                 std::string space, const ReadOptions& options);

}  // namespace isolux::detail
