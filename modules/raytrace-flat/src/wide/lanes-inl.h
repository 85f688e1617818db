// Vectors of rays in mirrored coordinates, and how they leave boxes. Included once per instruction set.
#if defined(ISOLUX_WIDE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_LANES_INL_H_
#undef ISOLUX_WIDE_LANES_INL_H_
#else
#define ISOLUX_WIDE_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "wide/rays.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vectors in arrays stay in registers only where the loops over them are unrolled.
#if defined(__clang__)
#define ISOLUX_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define ISOLUX_UNROLL _Pragma("GCC unroll 8")
#else
#define ISOLUX_UNROLL
#endif

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Ints = hn::Vec<IntTag>;
using Mask = hn::Mask<FloatTag>;

inline constexpr FloatTag kF{};
inline constexpr IntTag kI{};

HWY_INLINE Floats lerp(Floats a, Floats b, Floats t) { return hn::MulAdd(t, hn::Sub(b, a), a); }
HWY_INLINE Mask float_mask(hn::Mask<IntTag> m) { return hn::RebindMask(kF, m); }
/// Adding 1.5 * 2^23 leaves a whole number below 2^22 in the low bits: cheaper than a conversion that minds overflow.
HWY_INLINE Ints floor_to_int(Floats x) {
  const Floats shift = hn::Set(kF, 12582912.0f);
  return hn::Sub(hn::BitCast(kI, hn::Add(hn::Floor(x), shift)), hn::BitCast(kI, shift));
}

/// A vector of rays in mirrored coordinates: on axes where a ray runs backwards, position p becomes -p and cell i
/// becomes ~i, both exactly, so that every ray moves towards higher coordinates.
struct Lanes {
  Floats origin[3];
  Floats direction[3];  ///< magnitudes, none zero
  Floats inverse[3];    ///< of direction
  Ints cell[3];
  Ints mirror[3];  ///< all bits set where the ray runs backwards
  Floats t;        ///< where the ray enters the cell
  Floats isovalue;
  Ints id;  ///< number of the ray in the batch; sign bit: it has not left its level set yet
};

/// Lanes that still lie on the level set they started on, having crossed nothing but flat cells.
HWY_INLINE Mask still_on_it(const Lanes& r) { return float_mask(hn::Lt(r.id, hn::Zero(kI))); }
HWY_INLINE Ints number_of(Ints id) { return hn::And(id, hn::Set(kI, 0x7FFFFFFF)); }
HWY_INLINE void mark(Lanes& r, Mask on_level_set) {
  const Ints marked = hn::Or(r.id, hn::Set(kI, -0x7FFFFFFF - 1));
  r.id = hn::IfThenElse(hn::RebindMask(kI, on_level_set), marked, number_of(r.id));
}

/// Where rays stand that leave through the planes `plane`: the parameter, and the cell behind.
struct Exit {
  Floats t;
  Ints cell[3];
  Mask through[3];  ///< lanes that leave through this axis' plane
};

/// Moves rays out of the boxes that end at the mirrored integer planes `plane`. The axis left through gets its plane's
/// integer and the others stay inside the box, whatever rounding says; t never decreases: no ray hangs or leaks.
HWY_INLINE Exit leave(const Lanes& r, const Ints (&plane)[3]) {
  Floats t_plane[3];
  for (int a = 0; a < 3; ++a) t_plane[a] = hn::Mul(hn::Sub(hn::ConvertTo(kF, plane[a]), r.origin[a]), r.inverse[a]);
  Exit exit;
  exit.t = hn::Max(r.t, hn::Min(t_plane[0], hn::Min(t_plane[1], t_plane[2])));
  const Ints one = hn::Set(kI, 1);
  for (int a = 0; a < 3; ++a) {
    const Ints reached = floor_to_int(hn::MulAdd(exit.t, r.direction[a], r.origin[a]));
    const Ints inside = hn::Min(hn::Max(reached, r.cell[a]), hn::Sub(plane[a], one));
    exit.through[a] = hn::Le(t_plane[a], exit.t);
    exit.cell[a] = hn::IfThenElse(hn::RebindMask(kI, exit.through[a]), plane[a], inside);
  }
  return exit;
}

/// Lanes whose (mirrored) cell lies in the volume, given that it once did: rays run upwards only.
HWY_INLINE Mask in_box(const Ints (&cell)[3], const Ints (&mirror)[3], const Ints (&last_cell)[3]) {
  // Mirrored, the last cell is ~0 = -1, all bits set.
  const auto beyond = [&](int a) { return hn::Gt(cell[a], hn::Or(last_cell[a], mirror[a])); };
  return float_mask(hn::Not(hn::Or(beyond(0), hn::Or(beyond(1), beyond(2)))));
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
