#pragma once

#include "scalars.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace isolux::detail {

enum class VtkXmlFormat : std::uint8_t { kText, kBase64, kRaw };

/// Where an array of a VTK XML file lies, and how. Before the bytes of one that is no text stands a header of whole
/// numbers: how many there are or, of compressed ones, how many blocks, how large each is, how large the last one if it
/// is smaller (else 0), and what each has become by zlib.
struct VtkXmlArray {
  std::string file;
  std::uint64_t offset = 0;
  VtkXmlFormat format = VtkXmlFormat::kText;
  bool alone = false;        ///< an element of its own, without other arrays behind it
  bool compressed = false;   ///< by zlib; never of text
  bool wide_header = false;  ///< numbers of the header are of 8 bytes instead of 4
  ScalarLayout layout;
};

/// The type that a DataArray's `type` names, such as "UInt8".
[[nodiscard]] std::optional<ScalarType> vtk_xml_type(std::string_view name);

/// Whether the file can hold so many values, as far as its size tells: before memory is asked for. \throw IoError
/// naming the file and the bytes expected
void require_room(const VtkXmlArray& array, std::uint64_t count);

/// \throw IoError naming the file for data that are too few, too many or damaged, or whose header does not fit `count`;
/// InvalidInput for a number that does not fit a float, or none of its type; Cancelled
[[nodiscard]] DecodedValues read_vtk_xml_array(const VtkXmlArray& array, std::uint64_t count,
                                               const ReadOptions& options, const Run& run);

}  // namespace isolux::detail
