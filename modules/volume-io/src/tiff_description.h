#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace isolux::detail {

/// What ImageJ or OME say in a TIFF's ImageDescription of what its pages are. Returns a remark where they are channels
/// or frames but can be the sections of one volume; else "". \throw InvalidInput naming `path` where they cannot, or
/// are not all there
[[nodiscard]] std::string check_description(const std::string& path, std::string_view description, std::uint64_t pages);

}  // namespace isolux::detail
