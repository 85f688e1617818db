#pragma once

#include <isolux/volume_io/volume_reader.h>

#include <optional>
#include <string>

namespace isolux::detail {

/// What a name of the form name_WxHxD_type.raw says (Open SciVis Datasets); little endian.
[[nodiscard]] std::optional<RawLayout> parse_raw_name(const std::string& path);

/// The name's end for a layout: "_64x64x64_uint8.raw".
[[nodiscard]] std::string raw_name_end(const RawLayout& layout);

}  // namespace isolux::detail
