#pragma once

#include <isolux/core/illumination_grid.h>

#include <cmath>
#include <cstddef>

namespace isolux::test {

/// rms over the texels of lights laid out alike.
inline double rms_difference(const IlluminationGrid& a, const IlluminationGrid& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i) squares += std::pow(double(a.values[i]) - double(b.values[i]), 2.0);
  return std::sqrt(squares / double(a.values.size()));
}

}  // namespace isolux::test
