#pragma once

#include <cstdint>
#include <string>

namespace isolux::detail {

/// What of a VTK XML file is XML.
struct VtkXmlText {
  std::string text;            ///< byte by byte as in the file; behind data that are appended, the ends of what is open
  std::uint64_t appended = 0;  ///< place in the file of appended data, behind their underscore; 0 if there are none
};

/// Tells VTK XML, of any kind of data set, by its content.
[[nodiscard]] bool is_vtk_xml(const std::string& path);

/// \throw IoError if the file does not end as XML of VTK does; InvalidInput if it does not begin so
[[nodiscard]] VtkXmlText read_vtk_xml_text(const std::string& path);

}  // namespace isolux::detail
