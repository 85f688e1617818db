#pragma once

#include "data_place.h"
#include "vtk_choice.h"

#include <isolux/core/lattice.h>

#include <cstdint>
#include <string>
#include <vector>

namespace isolux::detail {

/// An array of a legacy VTK file and where its values lie.
struct LegacyVtkArray {
  VtkArrayInfo info;
  ScalarType type = ScalarType::kUint8;
  std::uint64_t offset = 0;
  bool colours = false;  ///< of COLOR_SCALARS, which as text are fractions of 255
};

/// A legacy VTK file of structured points: its grid, and its arrays as far as they can be followed.
struct LegacyVtk {
  std::string file;
  bool text = false;  ///< values are written as numbers with blanks between, else as bytes, big endian
  Lattice points;     ///< checked
  Lattice cells;
  std::vector<LegacyVtkArray> arrays;
  std::string remark;  ///< why what stands behind them was not followed; empty if all was

  [[nodiscard]] const Lattice& lattice_of(const LegacyVtkArray& array) const {
    return array.info.of_cells ? cells : points;
  }
};

/// Tells legacy VTK by its content.
[[nodiscard]] bool is_legacy_vtk(const std::string& path);

/// \throw IoError, InvalidInput naming the file, the value and what is allowed. What is wrong behind an array that can
/// be read is no error.
[[nodiscard]] LegacyVtk read_legacy_vtk(const std::string& path);

/// The values of one of its arrays that is plain. \throw IoError, InvalidInput, Cancelled; of text also for what is no
/// number of its type, and for more numbers
[[nodiscard]] DecodedValues read_legacy_vtk_values(const LegacyVtk& file, const LegacyVtkArray& array,
                                                   const ReadOptions& options, const Run& run);

}  // namespace isolux::detail
