// Third stage: do the rays meet their level set in the cells where they stand?
#if defined(ISOLUX_WIDE_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_TEST_INL_H_
#undef ISOLUX_WIDE_TEST_INL_H_
#else
#define ISOLUX_WIDE_TEST_INL_H_
#endif

#include "wide/deflated-inl.h"
#include "wide/solve-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// Where rays enter and leave their cell, in the cell's own coordinates, not mirrored. On the faces that they pass the
/// places are exact: a level set may lie in a face.
HWY_INLINE void places_in_cell(const Lanes& r, const Exit& exit, Floats (&from)[3], Floats (&to)[3]) {
  const Floats zero = hn::Zero(kF);
  const Floats unit = hn::Set(kF, 1.0f);
  for (int a = 0; a < 3; ++a) {
    const Floats base = hn::Sub(r.origin[a], hn::ConvertTo(kF, r.cell[a]));
    // The very product that made t when the ray came through this face.
    const Mask through_face = hn::Le(r.t, hn::Mul(hn::Neg(base), r.inverse[a]));
    const Floats inside = hn::Min(unit, hn::Max(zero, hn::MulAdd(r.t, r.direction[a], base)));
    const Floats enter = hn::IfThenZeroElse(through_face, inside);
    const Floats out = hn::Min(unit, hn::Max(zero, hn::MulAdd(exit.t, r.direction[a], base)));
    const Floats leave_at = hn::IfThenElse(exit.through[a], unit, out);
    const Mask backwards = hn::MaskFromVec(hn::BitCast(kF, r.mirror[a]));
    from[a] = hn::IfThenElse(backwards, hn::Sub(unit, enter), enter);
    to[a] = hn::IfThenElse(backwards, hn::Sub(unit, leave_at), leave_at);
  }
}

/// The answers for rays that enter a cell still on their level set, whose root at the entry is none: in place of what
/// the cubic says of `fresh` lanes. Rare (plateaus, sites beside a face), so it has its own branch.
HWY_INLINE void restart(Mask fresh, const Cubic& cubic, Floats noise, Floats t_leave, Lanes& r, Mask& hit,
                        Mask& doubtful, Floats& high, Floats& t_enter) {
  const Deflated polynomial = deflated(cubic);
  const Floats zero = hn::Zero(kF);
  Floats root;
  const Mask blocked = goes_inwards(polynomial);
  const Mask again = hn::AndNot(blocked, next_root(polynomial, hn::Set(kF, 1.0f), root));
  const Mask answered = hn::And(fresh, hn::Or(blocked, again));
  hit = hn::Or(hn::AndNot(fresh, hit), answered);
  // A bracket of no length: the root is its own entry.
  high = hn::IfThenElse(fresh, zero, high);
  t_enter = hn::IfThenElse(hn::And(fresh, again), lerp(r.t, t_leave, root), t_enter);
  const Floats whole = hn::Set(kF, 1.0f);
  const Mask unsure = hn::Or(again, is_doubtful(polynomial, whole, noise));
  doubtful = hn::Or(hn::AndNot(fresh, doubtful), hn::And(fresh, unsure));
  mark(r, hn::And(fresh, stays_on_it(polynomial, whole, noise)));
}

/// Third stage: tests the cells of the waiting rays; hits go to `roots` (or are answered at once if any hit will do),
/// the rest travels on from the next cell.
template <Question question>
void test(const CellReader& cells, RayQueue& waiting, RayQueue& travelling, RootQueue& roots, Rays& rays) {
  const Floats zero = hn::Zero(kF);
  const Ints one = hn::Set(kI, 1);
  const std::size_t lanes = hn::Lanes(kF);
  for (std::size_t at = 0; at < waiting.count; at += lanes) {
    if (at + 3 * lanes <= waiting.count) prefetch_cells(cells, waiting, at + 2 * lanes);
    Lanes r = load_lanes(waiting, at);
    const Mask present = hn::FirstN(kF, waiting.count - at);
    const Ints planes[3] = {hn::Add(r.cell[0], one), hn::Add(r.cell[1], one), hn::Add(r.cell[2], one)};
    const Exit exit = leave(r, planes);
    Ints cell[3];
    for (int a = 0; a < 3; ++a)
      cell[a] = hn::IfThenElseZero(hn::RebindMask(kI, present), hn::Xor(r.cell[a], r.mirror[a]));
    Floats from[3];
    Floats to[3];
    places_in_cell(r, exit, from, to);
    const Corners corners = cells.corners(cells.offset(cell), r.isovalue);
    const Floats most = largest(corners);
    Cubic cubic = along(corners, from, to);
    cubic.scale(to_unit(most));
    // Reached already at the entry: the root lies on the face, on the last cell's side by rounding.
    const Mask at_entry = hn::And(present, hn::Ge(cubic.b[0], zero));
    Floats high;
    const Floats noise = hn::Mul(rounding(most, r.isovalue, exit.t), to_unit(most));
    Mask doubtful;
    Mask hit = hn::Or(at_entry, hn::And(present, reaches_zero(cubic, noise, high, doubtful)));
    doubtful = hn::And(present, hn::Or(doubtful, at_entry));
    high = hn::IfThenElse(at_entry, zero, high);
    Floats t_enter = r.t;
    const Mask fresh = hn::And(present, still_on_it(r));
    if (!hn::AllFalse(kF, fresh)) restart(fresh, cubic, noise, exit.t, r, hit, doubtful, high, t_enter);
    if (!hn::AllFalse(kF, doubtful)) {
      doubt(doubtful, r.id, rays);
      hit = hn::AndNot(doubtful, hit);
    }
    if (question == Question::kAnyHit) {
      for_each_ray(hit, r.id, [&](std::size_t ray) { rays.t[ray] = 0.0f; });
    } else {
      append_roots(roots, cubic, high, noise, r.id, t_enter, exit.t, hit);
    }
    for (int a = 0; a < 3; ++a) r.cell[a] = exit.cell[a];
    r.t = exit.t;
    const Mask on = hn::AndNot(hn::Or(hit, doubtful), present);
    append_lanes(travelling, r, hn::And(on, in_box(r.cell, r.mirror, cells.last_cell)));
  }
  waiting.count = 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
