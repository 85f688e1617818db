#pragma once

#include <isolux/core/volume.h>

#include <cmath>
#include <cstddef>

namespace isolux {

/// Of the values that are finite.
struct ValueMoments {
  std::size_t count = 0;
  double mean = 0.0;
  double standard_deviation = 0.0;  ///< about the mean, divided by the number of values
};

/// Cost: two passes.
[[nodiscard]] ValueMoments value_moments(const auto& values) {
  ValueMoments moments;
  double sum = 0.0;
  for (const float v : values) {
    if (!std::isfinite(v)) continue;
    sum += double(v);
    ++moments.count;
  }
  if (moments.count == 0) return moments;
  moments.mean = sum / double(moments.count);
  double squares = 0.0;
  for (const float v : values) {
    if (std::isfinite(v)) squares += (double(v) - moments.mean) * (double(v) - moments.mean);
  }
  moments.standard_deviation = std::sqrt(squares / double(moments.count));
  return moments;
}

}  // namespace isolux
