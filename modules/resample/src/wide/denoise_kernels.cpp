// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/denoise_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

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

DenoiseKernels denoise_kernels(std::size_t channels) { return HWY_DYNAMIC_DISPATCH(kernels_for)(channels); }

}  // namespace isolux::wide
#endif
