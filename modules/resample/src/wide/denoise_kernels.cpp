// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/denoise_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "wide/denoise_kernels.h"
#include "wide/window_fits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

DenoiseKernels kernels_for(std::size_t channels) {
  return {.fit_row = channels == 1 ? fit_row<1> : fit_row<3>, .lanes = kRowLanes};
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::wide {

HWY_EXPORT(kernels_for);

DenoiseKernels denoise_kernels(std::size_t channels) { return HWY_DYNAMIC_DISPATCH(kernels_for)(channels); }

}  // namespace isolux::wide
#endif
