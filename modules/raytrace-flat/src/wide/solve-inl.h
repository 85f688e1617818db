// Last stage: where the rays hit.
#if defined(ISOLUX_WIDE_SOLVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_SOLVE_INL_H_
#undef ISOLUX_WIDE_SOLVE_INL_H_
#else
#define ISOLUX_WIDE_SOLVE_INL_H_
#endif

#include "wide/cubic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// Cubics with a root, waiting for the last stage.
struct RootQueue {
  alignas(64) float b[4][RayQueue::kCapacity + 2 * kPadding];
  alignas(64) float high[RayQueue::kCapacity + 2 * kPadding];
  alignas(64) float noise[RayQueue::kCapacity + 2 * kPadding];  ///< of the cubic's values
  alignas(64) float t_enter[RayQueue::kCapacity + 2 * kPadding];
  alignas(64) float t_leave[RayQueue::kCapacity + 2 * kPadding];
  alignas(64) float id[RayQueue::kCapacity + 2 * kPadding];
  std::size_t count = 0;

  [[nodiscard]] std::size_t ray(std::size_t at) const { return std::size_t(std::bit_cast<std::int32_t>(id[at])); }
};

HWY_INLINE void append_roots(RootQueue& roots, const Cubic& cubic, Floats high, Floats noise, Ints id, Floats t_enter,
                             Floats t_leave, Mask mask) {
  const Packing packing(mask);
  const std::size_t at = roots.count;
  for (int i = 0; i < 4; ++i) packing.store(cubic.b[i], roots.b[i] + at);
  packing.store(high, roots.high + at);
  packing.store(noise, roots.noise + at);
  packing.store(t_enter, roots.t_enter + at);
  packing.store(t_leave, roots.t_leave + at);
  packing.store(hn::BitCast(kF, number_of(id)), roots.id + at);
  roots.count += packing.count();
}

/// Last stage: solves the queued cubics. Where rounding may shift a root by more than the accuracy promised (a ray that
/// grazes its level set) the hit is vague.
void solve(RootQueue& roots, Rays& rays) {
  alignas(64) float t[hn::MaxLanes(kF)];
  const std::size_t lanes = hn::Lanes(kF);
  for (std::size_t at = 0; at < roots.count; at += lanes) {
    Cubic cubic;
    for (int i = 0; i < 4; ++i) cubic.b[i] = hn::LoadU(kF, roots.b[i] + at);
    const Floats high = hn::LoadU(kF, roots.high + at);
    const Floats enter = hn::LoadU(kF, roots.t_enter + at);
    const Floats leave_at = hn::LoadU(kF, roots.t_leave + at);
    const Mask known = hn::Le(high, hn::Zero(kF));
    const Floats s = hn::IfThenZeroElse(known, bracketed_root(cubic, high));
    hn::Store(lerp(enter, leave_at, s), kF, t);
    const std::size_t n = HWY_MIN(lanes, roots.count - at);
    for (std::size_t i = 0; i < n; ++i) rays.t[roots.ray(at + i)] = t[i];
    // Newton's steps are slow where the ray nearly touches: what they left counts, too.
    const Floats off = hn::Add(hn::LoadU(kF, roots.noise + at), hn::Abs(value(cubic, s)));
    const Floats shift = hn::Mul(off, hn::Sub(leave_at, enter));
    const Mask sure = hn::Or(known, hn::Le(shift, hn::Mul(slope(cubic, s), hn::Set(kF, kAccuracy))));
    const Mask unsure = hn::AndNot(sure, hn::FirstN(kF, n));
    for_each_ray(unsure, load_ints(roots.id + at), [&](std::size_t ray) { rays.vague.push_back(std::uint32_t(ray)); });
  }
  roots.count = 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
