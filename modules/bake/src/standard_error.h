#pragma once

#include <cmath>
#include <limits>
#include <span>

namespace isolux {

/// Root of the mean variance of the sites whose rays say anything of it (tracers give others the largest float); NaN if
/// there are none.
inline double standard_error(std::span<const float> variances) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const float v : variances) {
    if (v >= std::numeric_limits<float>::max()) continue;
    sum += double(v);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / double(count)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace isolux
