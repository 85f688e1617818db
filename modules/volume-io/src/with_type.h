#pragma once

#include <isolux/core/error.h>
#include <isolux/volume_io/scalar_type.h>

#include <cstdint>

namespace isolux::detail {

/// Calls f with a value of the C++ type that `type` names.
template <class F>
auto with_type(ScalarType type, const F& f) {
  switch (type) {
    case ScalarType::kInt8:
      return f(std::int8_t{});
    case ScalarType::kUint8:
      return f(std::uint8_t{});
    case ScalarType::kInt16:
      return f(std::int16_t{});
    case ScalarType::kUint16:
      return f(std::uint16_t{});
    case ScalarType::kInt32:
      return f(std::int32_t{});
    case ScalarType::kUint32:
      return f(std::uint32_t{});
    case ScalarType::kInt64:
      return f(std::int64_t{});
    case ScalarType::kUint64:
      return f(std::uint64_t{});
    case ScalarType::kFloat32:
      return f(float{});
    case ScalarType::kFloat64:
      return f(double{});
  }
  throw InvalidInput("unknown scalar type");
}

}  // namespace isolux::detail
