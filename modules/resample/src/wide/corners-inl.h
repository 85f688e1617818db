// The texels at the corners of a cell: four pairs of neighbours in planes of numbers. Included once per instruction
// set.
#if defined(ISOLUX_WIDE_CORNERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_CORNERS_INL_H_
#undef ISOLUX_WIDE_CORNERS_INL_H_
#else
#define ISOLUX_WIDE_CORNERS_INL_H_
#endif

#include <hwy/highway.h>

#include "wide/eight-inl.h"
#include "wide/fit_products.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
inline constexpr hn::FixedTag<float, 2> kPair{};
inline constexpr hn::FixedTag<float, 4> kTwoPairs{};
using Pair = hn::Vec<hn::FixedTag<float, 2>>;
using TwoPairs = hn::Vec<hn::FixedTag<float, 4>>;

template <class Eight>
HWY_INLINE Eight joined(TwoPairs lower, TwoPairs upper) {
  Eight s;
  if constexpr (Eight::kParts == 1) {
    s.part[0] = hn::Combine(typename Eight::Tag(), upper, lower);
  } else {
    s.part[0] = lower;
    s.part[1] = upper;
  }
  return s;
}

template <class Eight>
HWY_INLINE TwoPairs half_of(const Eight& s, std::size_t half) {
  if constexpr (Eight::kParts == 1) {
    return half == 0 ? hn::LowerHalf(kTwoPairs, s.part[0]) : hn::UpperHalf(kTwoPairs, s.part[0]);
  } else {
    return s.part[half];
  }
}

HWY_INLINE TwoPairs load_pairs(const float* lower, const float* upper) {
  return hn::Combine(kTwoPairs, hn::LoadU(kPair, upper), hn::LoadU(kPair, lower));
}

HWY_INLINE void add_pair(float* to, Pair pair) { hn::StoreU(hn::Add(hn::LoadU(kPair, to), pair), kPair, to); }
#endif

struct Corners {
  std::size_t first[4];  ///< those at lower x
  bool has_pairs;

  HWY_INLINE Corners(const FitCells& cells, std::size_t cell) : has_pairs(cells.has_pairs) {
    for (std::size_t p = 0; p < 4; ++p) first[p] = cells.texels[p][cell];
  }

  [[nodiscard]] HWY_INLINE Several<float, 8> load_from(const float* plane) const {
#if HWY_TARGET != HWY_SCALAR
    if (has_pairs) {
      return joined<Several<float, 8>>(load_pairs(plane + first[0], plane + first[1]),
                                       load_pairs(plane + first[2], plane + first[3]));
    }
#endif
    HWY_ALIGN float lanes[8];
    for (std::size_t q = 0; q < 8; ++q) lanes[q] = plane[first[q >> 1] + (has_pairs ? q & 1u : 0)];
    return load<8>(lanes, 0.0f);
  }

  HWY_INLINE void add_to(float* plane, const Several<float, 8>& s) const {
#if HWY_TARGET != HWY_SCALAR
    if (has_pairs) {
      ISOLUX_UNROLL
      for (std::size_t half = 0; half < 2; ++half) {
        const TwoPairs two = half_of(s, half);
        add_pair(plane + first[2 * half], hn::LowerHalf(kPair, two));
        add_pair(plane + first[2 * half + 1], hn::UpperHalf(kPair, two));
      }
      return;
    }
#endif
    HWY_ALIGN float lanes[8];
    store(s, lanes);
    for (std::size_t q = 0; q < 8; ++q) plane[first[q >> 1] + (has_pairs ? q & 1u : 0)] += lanes[q];
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();
#endif
