// The corner values of many cells at once.
#if defined(ISOLUX_WIDE_CORNERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_CORNERS_INL_H_
#undef ISOLUX_WIDE_CORNERS_INL_H_
#else
#define ISOLUX_WIDE_CORNERS_INL_H_
#endif

#include <hwy/cache_control.h>

#include "wide/queue-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// Roots that rounding may shift by more are asked of double precision: in voxels, some of what is promised.
inline constexpr float kAccuracy = 4e-5f;

/// Values at the corners, x fastest, less the isovalue, negated for the outer side of higher values: a ray runs where
/// they are negative and meets its level set where they reach zero.
struct Corners {
  Floats v[8];
};

struct CellReader {
  const float* row[4];  ///< the volume, shifted by the offsets of (y, z), (y+1, z), (y, z+1), (y+1, z+1)
  Ints stride_y;
  Ints stride_z;
  Ints last_cell[3];
  Floats sign;  ///< sign bit set if values are to be negated

  explicit CellReader(const FieldView& field) {
    const std::size_t y = std::size_t(field.size.x);
    const std::size_t z = y * std::size_t(field.size.y);
    row[0] = field.values;
    row[1] = field.values + y;
    row[2] = field.values + z;
    row[3] = field.values + y + z;
    stride_y = hn::Set(kI, int(y));
    stride_z = hn::Set(kI, int(z));
    for (int a = 0; a < 3; ++a) last_cell[a] = hn::Set(kI, field.size[a] - 2);
    sign = hn::Set(kF, field.outer == OuterSide::kLower ? 0.0f : -0.0f);
  }

  [[nodiscard]] HWY_INLINE Ints offset(const Ints (&cell)[3]) const {
    return hn::Add(cell[0], hn::Add(hn::Mul(cell[1], stride_y), hn::Mul(cell[2], stride_z)));
  }

  HWY_INLINE void pair(const float* from, Ints offset, Floats& low, Floats& high) const {
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3
    // Neighbours on x lie side by side: one gather of 64 bits brings both, at half the price.
    const hn::RepartitionToWide<IntTag> wide;
    const hn::Half<IntTag> half;
    const auto* pairs = reinterpret_cast<const std::int64_t*>(from);
    const auto first = hn::ShiftLeft<2>(hn::PromoteTo(wide, hn::LowerHalf(half, offset)));
    const auto second = hn::ShiftLeft<2>(hn::PromoteTo(wide, hn::UpperHalf(half, offset)));
    const Floats a = hn::BitCast(kF, hn::GatherOffset(wide, pairs, first));
    const Floats b = hn::BitCast(kF, hn::GatherOffset(wide, pairs, second));
    low = hn::ConcatEven(kF, b, a);
    high = hn::ConcatOdd(kF, b, a);
#else
    low = hn::GatherIndex(kF, from, offset);
    high = hn::GatherIndex(kF, from + 1, offset);
#endif
  }

  /// \pre the cells of all lanes lie in the volume
  [[nodiscard]] HWY_INLINE Corners corners(Ints offset, Floats isovalue) const {
    Corners c;
    for (int q = 0; q < 4; ++q) pair(row[q], offset, c.v[2 * q], c.v[2 * q + 1]);
    for (int q = 0; q < 8; ++q) c.v[q] = hn::Xor(hn::Sub(c.v[q], isovalue), sign);
    return c;
  }
};

/// The field less the isovalue at a place in the cell.
HWY_INLINE Floats value(const Corners& c, const Floats (&at)[3]) {
  Floats z[2];
  for (int q = 0; q < 2; ++q) {
    const Floats* v = c.v + 4 * q;
    z[q] = lerp(lerp(v[0], v[1], at[0]), lerp(v[2], v[3], at[0]), at[1]);
  }
  return lerp(z[0], z[1], at[2]);
}

HWY_INLINE Floats largest(const Corners& k) {
  Floats most = hn::Abs(k.v[0]);
  for (int q = 1; q < 8; ++q) most = hn::Max(most, hn::Abs(k.v[q]));
  return most;
}

/// A power of two that makes numbers up to `largest` numbers below 2, so that their squares neither overflow nor vanish
/// whatever the unit of the volume. No bit is lost.
HWY_INLINE Floats to_unit(Floats largest) {
  const Ints exponent = hn::And(hn::BitCast(kI, largest), hn::Set(kI, 0x7F800000));
  return hn::BitCast(kF, hn::Max(hn::Sub(hn::Set(kI, 0x7F000000), exponent), hn::Set(kI, 0x00800000)));
}

/// How far the kernels may be wrong about the field in a cell of values up to `largest` that a ray leaves at t: a
/// rounding or two of its values, of the isovalue, and of the ray's place times the field's slope.
HWY_INLINE Floats rounding(Floats largest, Floats isovalue, Floats t) {
  const Floats unit = hn::Set(kF, 0x1p-23f);
  return hn::MulAdd(t, hn::Mul(unit, largest), hn::Mul(unit, hn::Max(largest, hn::Abs(isovalue))));
}

/// Asks for the corner values of the vector of cells at `at` ahead of their use.
HWY_INLINE void prefetch_cells(const CellReader& cells, const RayQueue& waiting, std::size_t at) {
  Ints x[3];
  for (int a = 0; a < 3; ++a) {
    const Ints mirror = hn::BroadcastSignBit(load_ints(waiting.field[3 + a] + at));
    x[a] = hn::Xor(load_ints(waiting.field[6 + a] + at), mirror);
  }
  alignas(64) std::int32_t offset[hn::MaxLanes(kI)];
  hn::Store(cells.offset(x), kI, offset);
  for (std::size_t lane = 0; lane < hn::Lanes(kI); ++lane)
    for (const float* row : cells.row) hwy::Prefetch(row + offset[lane]);
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
