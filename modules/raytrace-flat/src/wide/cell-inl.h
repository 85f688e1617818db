// The trilinear cell: corner values of many cells at once, the field along a piece of a ray, and its roots.
#if defined(ISOLUX_WIDE_CELL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_CELL_INL_H_
#undef ISOLUX_WIDE_CELL_INL_H_
#else
#define ISOLUX_WIDE_CELL_INL_H_
#endif

#include "wide/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

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

/// A cubic on [0, 1] in Bernstein form: if no coefficient reaches zero, neither does the cubic.
struct Cubic {
  Floats b[4];
};

/// The field along the straight piece from `from` to `to` (places in the cell, 0 to 1): the corner values of the box
/// they span, averaged over the permutations of the axes (Ramshaw's blossom of the trilinear form).
HWY_INLINE Cubic along(const Corners& c, const Floats (&from)[3], const Floats (&to)[3]) {
  Floats x[2][4];  // the cell's x edges at from.x and to.x
  for (int q = 0; q < 4; ++q) {
    x[0][q] = lerp(c.v[2 * q], c.v[2 * q + 1], from[0]);
    x[1][q] = lerp(c.v[2 * q], c.v[2 * q + 1], to[0]);
  }
  Floats box[2][2][2];  // by x, y, z
  for (int i = 0; i < 2; ++i) {
    const Floats y_from[2] = {lerp(x[i][0], x[i][1], from[1]), lerp(x[i][2], x[i][3], from[1])};
    const Floats y_to[2] = {lerp(x[i][0], x[i][1], to[1]), lerp(x[i][2], x[i][3], to[1])};
    box[i][0][0] = lerp(y_from[0], y_from[1], from[2]);
    box[i][0][1] = lerp(y_from[0], y_from[1], to[2]);
    box[i][1][0] = lerp(y_to[0], y_to[1], from[2]);
    box[i][1][1] = lerp(y_to[0], y_to[1], to[2]);
  }
  const Floats third = hn::Set(kF, 1.0f / 3.0f);
  return {{box[0][0][0], hn::Mul(hn::Add(hn::Add(box[0][0][1], box[0][1][0]), box[1][0][0]), third),
           hn::Mul(hn::Add(hn::Add(box[0][1][1], box[1][0][1]), box[1][1][0]), third), box[1][1][1]}};
}

HWY_INLINE Floats value(const Cubic& c, Floats s) {
  const Floats p = lerp(c.b[0], c.b[1], s);
  const Floats q = lerp(c.b[1], c.b[2], s);
  const Floats r = lerp(c.b[2], c.b[3], s);
  return lerp(lerp(p, q, s), lerp(q, r, s), s);
}

HWY_INLINE Floats slope(const Cubic& c, Floats s) {
  const Floats d[3] = {hn::Sub(c.b[1], c.b[0]), hn::Sub(c.b[2], c.b[1]), hn::Sub(c.b[3], c.b[2])};
  return hn::Mul(hn::Set(kF, 3.0f), lerp(lerp(d[0], d[1], s), lerp(d[1], d[2], s), s));
}

/// Lanes whose cubic, negative at 0, reaches zero in [0, 1]; `high` gets an end of a bracket of the first root: the
/// interior maximum if that reaches zero, else 1. `doubtful` gets the lanes that `rounding` could decide otherwise.
HWY_INLINE Mask reaches_zero(const Cubic& c, Floats rounding, Floats& high, Mask& doubtful) {
  const Floats zero = hn::Zero(kF);
  const Floats one = hn::Set(kF, 1.0f);
  high = one;
  const Mask at_end = hn::Ge(c.b[3], zero);
  doubtful = hn::Le(hn::Abs(c.b[3]), rounding);
  const Mask may = hn::Or(hn::Ge(c.b[1], zero), hn::Ge(c.b[2], zero));
  if (hn::AllFalse(kF, may)) return at_end;
  // The derivative A s^2 + B s + C has its falling root at the maximum; each form is stable for one sign of B.
  const Floats d0 = hn::Sub(c.b[1], c.b[0]);
  const Floats d1 = hn::Sub(c.b[2], c.b[1]);
  const Floats d2 = hn::Sub(c.b[3], c.b[2]);
  const Floats half_slope = hn::Sub(d1, d0);
  const Floats b = hn::Add(half_slope, half_slope);
  const Floats a = hn::Add(hn::Sub(d0, hn::Add(d1, d1)), d2);
  const Floats discriminant = hn::NegMulAdd(hn::Mul(hn::Set(kF, 4.0f), a), d0, hn::Mul(b, b));
  const Floats root = hn::Sqrt(hn::Max(discriminant, zero));
  const Mask falling = hn::Lt(b, zero);
  const Floats numerator = hn::IfThenElse(falling, hn::Add(d0, d0), hn::Neg(hn::Add(b, root)));
  const Floats denominator = hn::IfThenElse(falling, hn::Sub(root, b), hn::Add(a, a));
  const Floats s = hn::Div(numerator, denominator);
  const Mask inside = hn::And(hn::Gt(s, zero), hn::Lt(s, one));
  const Mask peak = hn::And(hn::And(may, inside), hn::Gt(discriminant, zero));
  const Floats top = value(c, s);
  const Mask over = hn::And(peak, hn::Ge(top, zero));
  doubtful = hn::Or(doubtful, hn::And(peak, hn::Le(hn::Abs(top), rounding)));
  high = hn::IfThenElse(over, s, one);
  return hn::Or(at_end, over);
}

/// The root of a cubic that is negative at 0, not at `high`, and has one root between: Newton's steps kept inside a
/// shrinking bracket.
HWY_INLINE Floats bracketed_root(const Cubic& c, Floats high) {
  constexpr int kSteps = 7;
  Floats low = hn::Zero(kF);
  const Floats zero = low;
  Floats s = hn::Mul(high, hn::Div(c.b[0], hn::Sub(c.b[0], value(c, high))));
  for (int step = 0; step < kSteps; ++step) {
    const Floats f = value(c, s);
    const Mask before = hn::Lt(f, zero);
    low = hn::IfThenElse(before, s, low);
    high = hn::IfThenElse(before, high, s);
    const Floats newton = hn::Sub(s, hn::Div(f, slope(c, s)));
    const Mask kept = hn::And(hn::Ge(newton, low), hn::Le(newton, high));
    s = hn::IfThenElse(kept, newton, hn::Mul(hn::Set(kF, 0.5f), hn::Add(low, high)));
  }
  return s;
}

/// The field less its value at a start inside the cell, along a ray: t (c[0] + c[1] t + c[2] t^2). The known root t = 0
/// is divided out exactly: the coefficients are the field's derivatives at the start, differences of corner values.
struct Deflated {
  Floats c[3];
};

/// `at`: the start's place in the cell; `d`: direction, index space.
HWY_INLINE Deflated deflated(const Corners& k, const Floats (&at)[3], const Floats (&d)[3]) {
  const auto& v = k.v;
  const Floats x[4] = {hn::Sub(v[1], v[0]), hn::Sub(v[3], v[2]), hn::Sub(v[5], v[4]), hn::Sub(v[7], v[6])};
  const Floats y[4] = {hn::Sub(v[2], v[0]), hn::Sub(v[3], v[1]), hn::Sub(v[6], v[4]), hn::Sub(v[7], v[5])};
  const Floats z[4] = {hn::Sub(v[4], v[0]), hn::Sub(v[5], v[1]), hn::Sub(v[6], v[2]), hn::Sub(v[7], v[3])};
  const Floats gx = lerp(lerp(x[0], x[1], at[1]), lerp(x[2], x[3], at[1]), at[2]);
  const Floats gy = lerp(lerp(y[0], y[1], at[0]), lerp(y[2], y[3], at[0]), at[2]);
  const Floats gz = lerp(lerp(z[0], z[1], at[0]), lerp(z[2], z[3], at[0]), at[1]);
  const Floats hxy = lerp(hn::Sub(x[1], x[0]), hn::Sub(x[3], x[2]), at[2]);
  const Floats hxz = lerp(hn::Sub(x[2], x[0]), hn::Sub(x[3], x[1]), at[1]);
  const Floats hyz = lerp(hn::Sub(y[2], y[0]), hn::Sub(y[3], y[1]), at[0]);
  const Floats hxyz = hn::Sub(hn::Sub(x[3], x[2]), hn::Sub(x[1], x[0]));
  const Floats dxy = hn::Mul(d[0], d[1]);
  return {{hn::MulAdd(gx, d[0], hn::MulAdd(gy, d[1], hn::Mul(gz, d[2]))),
           hn::MulAdd(hxy, dxy, hn::Mul(d[2], hn::MulAdd(hxz, d[0], hn::Mul(hyz, d[1])))),
           hn::Mul(hxyz, hn::Mul(dxy, d[2]))}};
}

/// Lanes whose deflated polynomial is positive just beyond 0: the ray goes straight into the inner side.
HWY_INLINE Mask goes_inwards(const Deflated& p) {
  const Floats zero = hn::Zero(kF);
  const Mask curves = hn::Or(hn::Gt(p.c[1], zero), hn::And(hn::Eq(p.c[1], zero), hn::Gt(p.c[2], zero)));
  return hn::Or(hn::Gt(p.c[0], zero), hn::And(hn::Eq(p.c[0], zero), curves));
}

/// Lanes whose deflated polynomial, not positive just beyond 0, has a root in (0, t_end]; `root` gets the first.
HWY_INLINE Mask next_root(const Deflated& p, Floats t_end, Floats& root) {
  const Floats zero = hn::Zero(kF);
  const Floats discriminant = hn::NegMulAdd(hn::Mul(hn::Set(kF, 4.0f), p.c[0]), p.c[2], hn::Mul(p.c[1], p.c[1]));
  const Floats denominator = hn::Add(p.c[1], hn::Sqrt(hn::Max(discriminant, zero)));
  root = hn::Div(hn::Mul(hn::Set(kF, -2.0f), p.c[0]), denominator);
  Mask real = hn::And(hn::Ge(discriminant, zero), hn::Gt(denominator, zero));
  const Mask tangent = hn::Eq(p.c[0], zero);
  if (!hn::AllFalse(kF, tangent)) {
    root = hn::IfThenElse(tangent, hn::Div(hn::Neg(p.c[1]), p.c[2]), root);
    real = hn::Or(hn::AndNot(tangent, real), hn::And(tangent, hn::And(hn::Lt(p.c[1], zero), hn::Gt(p.c[2], zero))));
  }
  return hn::And(real, hn::Le(root, t_end));
}

/// The same polynomial for a start at the cubic's beginning, over its own parameter.
HWY_INLINE Deflated deflated(const Cubic& c) {
  const Floats three = hn::Set(kF, 3.0f);
  const Floats first = hn::Mul(three, hn::Sub(c.b[1], c.b[0]));
  const Floats twice_middle = hn::Mul(three, hn::Sub(c.b[2], c.b[0]));
  const Floats last = hn::Sub(c.b[3], c.b[0]);
  return {{first, hn::Sub(twice_middle, hn::Add(first, first)), hn::Add(hn::Sub(first, twice_middle), last)}};
}

/// How far the kernels may be wrong about the field in a cell that a ray leaves at t: a rounding or two of its values,
/// of the isovalue, and of the ray's place times the field's slope.
HWY_INLINE Floats rounding(const Corners& k, Floats isovalue, Floats t) {
  Floats largest = hn::Abs(k.v[0]);
  for (int q = 1; q < 8; ++q) largest = hn::Max(largest, hn::Abs(k.v[q]));
  return hn::Mul(hn::Set(kF, 0x1p-23f), hn::MulAdd(t, largest, hn::Max(largest, hn::Abs(isovalue))));
}

/// Lanes of rays that nowhere up to t get off their level set by more than a rounding: the next cell is then the first.
HWY_INLINE Mask stays_on_it(const Deflated& p, Floats t, Floats rounding) {
  const Floats bound = hn::MulAdd(t, hn::MulAdd(t, hn::Abs(p.c[2]), hn::Abs(p.c[1])), hn::Abs(p.c[0]));
  return hn::Le(hn::Mul(t, bound), rounding);
}

/// The slope of the field along the ray at a root of the deflated polynomial.
HWY_INLINE Floats slope_at_root(const Deflated& p, Floats root) {
  return hn::Mul(root, hn::MulAdd(hn::Add(root, root), p.c[2], p.c[1]));
}

/// Lanes in which `rounding` could decide otherwise whether a ray is blocked at its start or meets its level set again
/// within t: it starts along the level set, passes through it at t, or touches it.
HWY_INLINE Mask is_doubtful(const Deflated& p, Floats t, Floats rounding) {
  const Floats discriminant = hn::NegMulAdd(hn::Mul(hn::Set(kF, 4.0f), p.c[0]), p.c[2], hn::Mul(p.c[1], p.c[1]));
  const Floats end = hn::Mul(t, hn::MulAdd(t, hn::MulAdd(t, p.c[2], p.c[1]), p.c[0]));
  const Mask touches = hn::Le(hn::Abs(discriminant), hn::Mul(hn::Abs(p.c[2]), rounding));
  const Mask at_edge = hn::Or(hn::Le(hn::Abs(p.c[0]), rounding), hn::Le(hn::Abs(end), rounding));
  return hn::AndNot(stays_on_it(p, t, hn::Zero(kF)), hn::Or(touches, at_edge));
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
