#pragma once

#include "number_text.h"
#include "scalars.h"

namespace isolux::detail {

/// What stands between numbers as C and C++ read them.
inline constexpr std::string_view kTextBlanks = " \n\r\t\f\v";

/// The next `count` numbers of a text, in floats, without ReadOptions::nodata and less ReadOptions::subtract. \throw
/// IoError naming `path` for fewer; InvalidInput for a word that is no number of `type`: as binary data, floats may be
/// infinite or NaN; Cancelled
[[nodiscard]] DecodedValues read_text_values(NumberText& text, ScalarType type, std::uint64_t count,
                                             const ReadOptions& options, const std::string& path, const Run& run);

}  // namespace isolux::detail
