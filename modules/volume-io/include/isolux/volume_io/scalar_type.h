#pragma once

#include <isolux/core/volume.h>

#include <cstddef>
#include <string_view>

namespace isolux {

/// "int8", "uint8", ... "int64", "uint64", "float32", "float64".
[[nodiscard]] std::string_view scalar_type_name(ScalarType type);
/// The type of that name. \throw InvalidInput naming the ten names.
[[nodiscard]] ScalarType parse_scalar_type(std::string_view name);
/// 1, 2, 4 or 8.
[[nodiscard]] std::size_t bytes_per_scalar(ScalarType type);

}  // namespace isolux
