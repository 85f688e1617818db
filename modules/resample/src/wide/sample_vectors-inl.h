// Samples in vectors, one a lane. Included once per instruction set.
#if defined(ISOLUX_WIDE_SAMPLE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_SAMPLE_VECTORS_INL_H_
#undef ISOLUX_WIDE_SAMPLE_VECTORS_INL_H_
#else
#define ISOLUX_WIDE_SAMPLE_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr hn::CappedTag<float, 16> kF{};
using F = hn::Vec<decltype(kF)>;

/// Of two samples' light, by the cosine of their normals.
HWY_INLINE F like_by(F cosine) {
  const auto in_front = hn::Max(cosine, hn::Zero(kF));
  return hn::MulAdd(in_front, in_front, hn::Set(kF, 1e-6f));
}

/// 1 where a squared difference of light is much less than 1, falling to 0 where it is more.
HWY_INLINE F same_side(F ratio) {
  return hn::Div(hn::Set(kF, 1.0f), hn::MulAdd(hn::Mul(ratio, ratio), ratio, hn::Set(kF, 1.0f)));
}

/// Four numbers of each of four samples to four arrays.
HWY_INLINE void take_four(const float* const (&from)[4], float* to, std::size_t apart) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t n = 0; n < 4; ++n)
    for (std::size_t a = 0; a < 4; ++a) to[a * apart + n] = from[n][a];
#else
  const hn::FixedTag<float, 4> f;
  const hn::RepartitionToWide<decltype(f)> pairs;
  const auto zero = hn::LoadU(f, from[0]);
  const auto one = hn::LoadU(f, from[1]);
  const auto two = hn::LoadU(f, from[2]);
  const auto three = hn::LoadU(f, from[3]);
  const auto lower01 = hn::BitCast(pairs, hn::InterleaveLower(f, zero, one));
  const auto upper01 = hn::BitCast(pairs, hn::InterleaveUpper(f, zero, one));
  const auto lower23 = hn::BitCast(pairs, hn::InterleaveLower(f, two, three));
  const auto upper23 = hn::BitCast(pairs, hn::InterleaveUpper(f, two, three));
  hn::Store(hn::BitCast(f, hn::InterleaveLower(pairs, lower01, lower23)), f, to);
  hn::Store(hn::BitCast(f, hn::InterleaveUpper(pairs, lower01, lower23)), f, to + apart);
  hn::Store(hn::BitCast(f, hn::InterleaveLower(pairs, upper01, upper23)), f, to + 2 * apart);
  hn::Store(hn::BitCast(f, hn::InterleaveUpper(pairs, upper01, upper23)), f, to + 3 * apart);
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();
#endif
