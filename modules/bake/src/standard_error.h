#pragma once

#include <isolux/core/sample_set.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace isolux {

/// Of the sites whose rays say anything of their variance (tracers give others the largest float).
class MeanVariance {
 public:
  void add(std::span<const float> variances) {
    for (const float v : variances) {
      if (v >= kUnknownVariance) continue;
      sum_ += double(v);
      ++count_;
    }
  }
  /// NaN if there are none.
  [[nodiscard]] double root() const {
    return count_ > 0 ? std::sqrt(sum_ / double(count_)) : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// MeanVariance::root() of all of them.
inline double standard_error(std::span<const float> variances) {
  MeanVariance mean;
  mean.add(variances);
  return mean.root();
}

}  // namespace isolux
