#pragma once

#include "vtk_choice.h"

#include <isolux/volume_io/scalar_type.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace isolux::detail {

/// The type that a word of legacy VTK names, in any case; nothing for those of which isolux reads no values.
[[nodiscard]] std::optional<ScalarType> vtk_scalar_type(const std::string& word);

/// A name as VTK's writer coded it, with %20 for a blank.
[[nodiscard]] std::string vtk_decoded(const std::string& name);

/// What one keyword says of an array: its role, and where its line has the numbers of values a tuple and the type.
struct VtkAttribute {
  const char* keyword;
  VtkRole role;
  std::uint64_t components;    ///< a tuple, if no word says it
  std::size_t component_word;  ///< 0: none
  std::size_t type_word;       ///< 0: bytes, and as text fractions
};

/// Nothing unless `keyword`, in lower case, begins an array of points or cells.
[[nodiscard]] const VtkAttribute* find_vtk_attribute(std::string_view keyword);

}  // namespace isolux::detail
