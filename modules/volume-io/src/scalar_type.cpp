#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/scalar_type.h>

#include <algorithm>
#include <array>

namespace isolux {
namespace {

// In the order of ScalarType.
constexpr std::array<std::string_view, 10> kNames = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                                     "uint32", "int64", "uint64", "float32", "float64"};
constexpr std::array<std::size_t, 10> kBytes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};

}  // namespace

std::string_view scalar_type_name(ScalarType type) { return kNames.at(std::size_t(type)); }

std::size_t bytes_per_scalar(ScalarType type) { return kBytes.at(std::size_t(type)); }

ScalarType parse_scalar_type(std::string_view name) {
  const auto it = std::find(kNames.begin(), kNames.end(), name);
  if (it == kNames.end())
    throw InvalidInput(fmt::format("scalar type '{}': allowed are {}", name, fmt::join(kNames, ", ")));
  return ScalarType(it - kNames.begin());
}

}  // namespace isolux
