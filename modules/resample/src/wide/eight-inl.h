// Eight numbers side by side, one for each corner of a cell, and four, one for each step of the near field: in one
// vector or in as many as it takes. Included once per instruction set.
#if defined(ISOLUX_WIDE_EIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_EIGHT_INL_H_
#undef ISOLUX_WIDE_EIGHT_INL_H_
#else
#define ISOLUX_WIDE_EIGHT_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vectors in arrays stay in registers only where the loops over them are unrolled.
#if defined(__clang__)
#define ISOLUX_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define ISOLUX_UNROLL _Pragma("GCC unroll 16")
#else
#define ISOLUX_UNROLL
#endif

template <class Real, std::size_t kCount>
struct Several {
  using Tag = hn::CappedTag<Real, kCount>;
  static constexpr std::size_t kLanes = hn::MaxLanes(Tag());
  static constexpr std::size_t kParts = kCount / kLanes;
  hn::Vec<Tag> part[kParts];
};

template <class Real, std::size_t kCount>
HWY_INLINE Several<Real, kCount> all(Real value) {
  Several<Real, kCount> s;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < s.kParts; ++p) s.part[p] = hn::Set(typename Several<Real, kCount>::Tag(), value);
  return s;
}

template <std::size_t kCount>
HWY_INLINE Several<float, kCount> load(const float* from, float /*as*/) {
  using S = Several<float, kCount>;
  S s;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < S::kParts; ++p) s.part[p] = hn::LoadU(typename S::Tag(), from + p * S::kLanes);
  return s;
}
template <std::size_t kCount>
HWY_INLINE Several<double, kCount> load(const double* from, double /*as*/) {
  using S = Several<double, kCount>;
  S s;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < S::kParts; ++p) s.part[p] = hn::LoadU(typename S::Tag(), from + p * S::kLanes);
  return s;
}
/// Floats as doubles.
template <std::size_t kCount>
HWY_INLINE Several<double, kCount> load(const float* from, double /*as*/) {
  using S = Several<double, kCount>;
  const hn::Rebind<float, typename S::Tag> floats;
  S s;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < S::kParts; ++p)
    s.part[p] = hn::PromoteTo(typename S::Tag(), hn::LoadU(floats, from + p * S::kLanes));
  return s;
}

template <class Real, std::size_t kCount>
HWY_INLINE void store(const Several<Real, kCount>& s, Real* to) {
  using S = Several<Real, kCount>;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < S::kParts; ++p) hn::StoreU(s.part[p], typename S::Tag(), to + p * S::kLanes);
}

template <class Real, std::size_t kCount>
HWY_INLINE Several<Real, kCount> mul(const Several<Real, kCount>& a, const Several<Real, kCount>& b) {
  Several<Real, kCount> s;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < s.kParts; ++p) s.part[p] = hn::Mul(a.part[p], b.part[p]);
  return s;
}
template <class Real, std::size_t kCount>
HWY_INLINE Several<Real, kCount> sub(const Several<Real, kCount>& a, const Several<Real, kCount>& b) {
  Several<Real, kCount> s;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < s.kParts; ++p) s.part[p] = hn::Sub(a.part[p], b.part[p]);
  return s;
}
/// a * b + c
template <class Real, std::size_t kCount>
HWY_INLINE Several<Real, kCount> mul_add(const Several<Real, kCount>& a, const Several<Real, kCount>& b,
                                         const Several<Real, kCount>& c) {
  Several<Real, kCount> s;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < s.kParts; ++p) s.part[p] = hn::MulAdd(a.part[p], b.part[p], c.part[p]);
  return s;
}

template <class Real, std::size_t kCount>
HWY_INLINE Several<Real, kCount> add(const Several<Real, kCount>& a, const Several<Real, kCount>& b) {
  Several<Real, kCount> s;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < s.kParts; ++p) s.part[p] = hn::Add(a.part[p], b.part[p]);
  return s;
}

/// As doubles.
template <std::size_t kCount>
HWY_INLINE Several<double, kCount> promoted(const Several<float, kCount>& a) {
  HWY_ALIGN float lanes[kCount];
  store(a, lanes);
  return load<kCount>(lanes, 0.0);
}

/// As floats.
HWY_INLINE Several<float, 8> demoted(const Several<double, 8>& a) {
  using S = Several<double, 8>;
  const hn::Rebind<float, S::Tag> floats;
  HWY_ALIGN float lanes[8];
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < S::kParts; ++p)
    hn::StoreU(hn::DemoteTo(floats, a.part[p]), floats, lanes + p * S::kLanes);
  return load<8>(lanes, 0.0f);
}

/// Lower plus upper half.
template <class Real>
HWY_INLINE Several<Real, 4> fold(const Several<Real, 8>& a) {
  Several<Real, 4> s;
#if HWY_TARGET != HWY_SCALAR
  if constexpr (Several<Real, 8>::kParts == 1) {
    const typename Several<Real, 4>::Tag half;
    s.part[0] = hn::Add(hn::LowerHalf(half, a.part[0]), hn::UpperHalf(half, a.part[0]));
    return s;
  } else
#endif
  {
    ISOLUX_UNROLL
    for (std::size_t p = 0; p < s.kParts; ++p) s.part[p] = hn::Add(a.part[p], a.part[p + s.kParts]);
    return s;
  }
}

template <class Real>
HWY_INLINE Real sum(const Several<Real, 4>& a) {
  using S = Several<Real, 4>;
  if constexpr (S::kParts == 4) {
    return (hn::GetLane(a.part[0]) + hn::GetLane(a.part[1])) + (hn::GetLane(a.part[2]) + hn::GetLane(a.part[3]));
  } else if constexpr (S::kParts == 2) {
    return hn::GetLane(hn::SumOfLanes(typename S::Tag(), hn::Add(a.part[0], a.part[1])));
  } else {
    return hn::GetLane(hn::SumOfLanes(typename S::Tag(), a.part[0]));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();
#endif
