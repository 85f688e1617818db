#pragma once

#include "data_place.h"

#include <isolux/core/lattice.h>

#include <string>

namespace isolux::detail {

/// The header of a legacy VTK file of structured points whose first attribute is one-component scalars, colours among
/// them, understood and checked.
struct LegacyVtk {
  Lattice lattice;
  DataPlace data;
  bool text = false;     ///< the values are written as numbers with blanks between
  bool colours = false;  ///< of COLOR_SCALARS, which as text are fractions of 255
  std::string name;      ///< of the scalars, in lower case
};

struct VtkValues {
  DecodedValues values;
  std::string left_out;  ///< the attribute behind them, as its line names it ("VECTORS v"); empty if there is none
};

/// Tells legacy VTK by its content.
[[nodiscard]] bool is_legacy_vtk(const std::string& path);

/// \throw IoError, InvalidInput naming the file, the value and what is allowed; also where the file cannot hold the
/// values promised
[[nodiscard]] LegacyVtk read_legacy_vtk_header(const std::string& path);

/// Further attributes may follow the values: the format says so. \throw IoError, InvalidInput, Cancelled; of text also
/// for what is no number of its type, and for more numbers
[[nodiscard]] VtkValues read_legacy_vtk_values(const LegacyVtk& header, const ReadOptions& options, const Run& run);

}  // namespace isolux::detail
