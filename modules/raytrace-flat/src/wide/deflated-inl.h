// The field along a ray that starts on its level set: the known root is divided out.
#if defined(ISOLUX_WIDE_DEFLATED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_DEFLATED_INL_H_
#undef ISOLUX_WIDE_DEFLATED_INL_H_
#else
#define ISOLUX_WIDE_DEFLATED_INL_H_
#endif

#include "wide/cubic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// The field less its value at a start inside the cell, along a ray: t (c[0] + c[1] t + c[2] t^2). The known root t = 0
/// is divided out exactly: the coefficients are the field's derivatives at the start, differences of corner values.
struct Deflated {
  Floats c[3];

  HWY_INLINE void scale(Floats by) {
    for (Floats& coefficient : c) coefficient = hn::Mul(coefficient, by);
  }
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

/// Lanes whose deflated polynomial, not positive just beyond 0, has a root in (0, t_end]; `root` gets the first. Of the
/// two forms of the root the one that adds what has one sign: a ray may leave along its level set all but exactly.
HWY_INLINE Mask next_root(const Deflated& p, Floats t_end, Floats& root) {
  const Floats zero = hn::Zero(kF);
  const Floats discriminant = hn::NegMulAdd(hn::Mul(hn::Set(kF, 4.0f), p.c[0]), p.c[2], hn::Mul(p.c[1], p.c[1]));
  const Floats sum = hn::Add(hn::Abs(p.c[1]), hn::Sqrt(hn::Max(discriminant, zero)));
  const Mask sinks = hn::Lt(p.c[1], zero);
  const Floats numerator = hn::IfThenElse(sinks, sum, hn::Mul(hn::Set(kF, -2.0f), p.c[0]));
  const Floats denominator = hn::IfThenElse(sinks, hn::Add(p.c[2], p.c[2]), sum);
  root = hn::Div(numerator, denominator);
  const Mask real = hn::And(hn::Ge(discriminant, zero), hn::Gt(denominator, zero));
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
  // Strictly: in a cell that is linear along the ray both sides are zero, and nothing is touched.
  const Mask touches = hn::Lt(hn::Abs(discriminant), hn::Mul(hn::Abs(p.c[2]), rounding));
  const Mask at_edge = hn::Or(hn::Le(hn::Abs(p.c[0]), rounding), hn::Le(hn::Abs(end), rounding));
  return hn::AndNot(stays_on_it(p, t, hn::Zero(kF)), hn::Or(touches, at_edge));
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
