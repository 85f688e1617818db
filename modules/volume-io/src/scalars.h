#pragma once

#include "byte_source.h"

#include <isolux/core/run.h>
#include <isolux/volume_io/scalar_type.h>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace isolux::detail {

/// How numbers lie in a file.
struct ScalarLayout {
  ScalarType type = ScalarType::kUint8;
  bool big_endian = false;
};

/// Number of values of a grid of these sizes. \throw InvalidInput naming `path` if a size is below 1 or above 2^31 - 1,
/// or if their bytes do not fit in 63 bits.
[[nodiscard]] std::uint64_t checked_count(const std::string& path, std::span<const std::int64_t> sizes,
                                          std::size_t bytes_per_value);

/// Reads `count` numbers and converts each to the nearest float. \throw IoError naming `path` and the bytes expected
/// and found if there are fewer; Cancelled. Memory follows what was read, not what was promised.
[[nodiscard]] std::vector<float> decode_scalars(ByteSource& source, const ScalarLayout& layout, std::uint64_t count,
                                                const std::string& path, const Run& run);

/// Encodes floats in pieces, little endian, and hands each piece on. Values must be representable: whole numbers within
/// the range of an integer type (its limits as rounded to float are taken as the limits themselves). \throw
/// InvalidInput naming the first value that is not.
void encode_scalars(std::span<const float> values, ScalarType type,
                    const std::function<void(std::span<const std::byte>)>& sink);

}  // namespace isolux::detail
