// The field along a piece of a ray through a cell, and its first root.
#if defined(ISOLUX_WIDE_CUBIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_CUBIC_INL_H_
#undef ISOLUX_WIDE_CUBIC_INL_H_
#else
#define ISOLUX_WIDE_CUBIC_INL_H_
#endif

#include "wide/corners-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// A cubic on [0, 1] in Bernstein form: if no coefficient reaches zero, neither does the cubic.
struct Cubic {
  Floats b[4];

  HWY_INLINE void scale(Floats by) {
    for (Floats& coefficient : b) coefficient = hn::Mul(coefficient, by);
  }
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

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
