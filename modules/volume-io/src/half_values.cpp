#include "half_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isolux::detail {
namespace {

// A sign, 5 bits of exponent, 10 of mantissa.
float float_of_half(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31;
  const int mantissa = bits & 1023;
  float size = std::ldexp(float(exponent > 0 ? mantissa + 1024 : mantissa), std::max(exponent, 1) - 25);
  if (exponent == 31) size = mantissa == 0 ? std::numeric_limits<float>::infinity() : std::nanf("");
  return (bits & 0x8000) != 0 ? -size : size;
}

}  // namespace

DecodedValues read_halves(const DataPlace& place, std::uint64_t count, const ReadOptions& options, const Run& run) {
  ReadOptions as_bits = options;
  as_bits.form = VoxelForm::kStored;
  as_bits.subtract = 0.0;
  as_bits.nodata.reset();
  AsWanted as_wanted(options, true);
  const auto bits = std::get<std::vector<std::uint16_t>>(read_values(place, count, as_bits, run).list);
  std::vector<float> values;
  values.reserve(count);
  for (const std::uint16_t half : bits) values.push_back(float(as_wanted(double(float_of_half(half)))));
  return {std::move(values), options.subtract != 0.0, as_wanted.found_nodata()};
}

}  // namespace isolux::detail
