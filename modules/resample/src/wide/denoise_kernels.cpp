// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/denoise_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "wide/denoise_kernels.h"
#include "wide/nearest-inl.h"
#include "wide/window_fits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

DenoiseKernels kernels_for(std::size_t channels) {
  return {.nearest = nearest, .fit = channels == 1 ? fit<1> : fit<3>};
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::wide {

HWY_EXPORT(kernels_for);

Stencil Stencil::of(const std::array<int, 3>& bins, std::size_t count) {
  using Bin = std::array<std::int32_t, 4>;  // class of its distance, z, y, x
  // A ball of `far` holds more than that many.
  std::int32_t far = 1;
  while (std::size_t(4 * far * far * far) < count) ++far;
  std::vector<Bin> around;
  for (std::int32_t k = -far; k <= far; ++k)
    for (std::int32_t j = -far; j <= far; ++j)
      for (std::int32_t i = -far; i <= far; ++i) around.push_back({class_of(float(k * k + j * j + i * i)), k, j, i});
  std::sort(around.begin(), around.end());
  Stencil stencil;
  std::array<std::int32_t, 3> reached{};
  for (std::size_t n = 0; n < count; ++n) {
    const auto [distance, k, j, i] = around[n];
    stencil.offsets.push_back((k * bins[1] + j) * bins[0] + i);
    reached = {std::max(reached[0], std::abs(i)), std::max(reached[1], std::abs(j)), std::max(reached[2], std::abs(k))};
    stencil.far.push_back(reached);
  }
  return stencil;
}

DenoiseKernels denoise_kernels(std::size_t channels) { return HWY_DYNAMIC_DISPATCH(kernels_for)(channels); }

}  // namespace isolux::wide
#endif
