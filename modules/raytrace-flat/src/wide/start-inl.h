// First stage: the cells that rays start in.
#if defined(ISOLUX_WIDE_START_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_START_INL_H_
#undef ISOLUX_WIDE_START_INL_H_
#else
#define ISOLUX_WIDE_START_INL_H_
#endif

#include "wide/deflated-inl.h"
#include "wide/prove-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// Components below this are taken for this: their planes are then beyond every box, and 1/d stays finite.
inline constexpr float kSmallestDirection = 1e-12f;

/// Takes the batch's rays [at, at + lanes) into mirrored coordinates. A ray that starts exactly on a face between cells
/// stands in the cell that it runs into, so that no first interval is empty.
HWY_INLINE Lanes start_lanes(const Rays& rays, std::size_t at, const Ints (&last_cell)[3]) {
  Lanes r;
  const Floats smallest = hn::Set(kF, kSmallestDirection);
  for (int a = 0; a < 3; ++a) {
    const Floats d = hn::LoadU(kF, rays.direction[a].data() + at);
    const Floats o = hn::LoadU(kF, rays.origin[a].data() + at);
    const Mask backwards = hn::Lt(d, hn::Zero(kF));
    r.mirror[a] = hn::BitCast(kI, hn::VecFromMask(kF, backwards));
    r.direction[a] = hn::Max(hn::Abs(d), smallest);
    r.inverse[a] = hn::Div(hn::Set(kF, 1.0f), r.direction[a]);
    r.origin[a] = hn::IfThenElse(backwards, hn::Neg(o), o);
    r.cell[a] = floor_to_int(r.origin[a]);
    // A ray that runs along the last face belongs to the cells below it.
    const auto along_face = hn::RebindMask(kI, hn::Eq(d, hn::Zero(kF)));
    r.cell[a] = hn::IfThenElse(along_face, hn::Min(r.cell[a], last_cell[a]), r.cell[a]);
  }
  r.t = hn::Zero(kF);
  r.isovalue = hn::LoadU(kF, rays.isovalue.data() + at);
  r.id = hn::Iota(kI, int(at));
  return r;
}

/// Lanes whose (mirrored) cell lies in the volume.
HWY_INLINE Mask starts_in_box(const Ints (&cell)[3], const Ints (&mirror)[3], const Ints (&last_cell)[3]) {
  Ints outside = hn::Zero(kI);
  for (int a = 0; a < 3; ++a) {
    const Ints x = hn::Xor(cell[a], mirror[a]);
    outside = hn::Or(outside, hn::Or(x, hn::Sub(last_cell[a], x)));
  }
  return float_mask(hn::Gt(outside, hn::Set(kI, -1)));
}

/// First stage: solves each ray's own cell and queues the rays that leave it. \pre the queue has room for the vectors
template <Question question>
void start(const CellReader& cells, float threshold, Prover& prover, Rays& rays, std::size_t begin, std::size_t end,
           RayQueue& travelling, TraceCounters& counters) {
  const Floats zero = hn::Zero(kF);
  const Ints one = hn::Set(kI, 1);
  for (std::size_t at = begin; at < end; at += hn::Lanes(kF)) {
    Lanes r = start_lanes(rays, at, cells.last_cell);
    const Mask present = hn::FirstN(kF, end - at);
    const Mask inside = hn::And(present, starts_in_box(r.cell, r.mirror, cells.last_cell));
    Ints cell[3];
    Floats place[3];
    Floats direction[3];
    for (int a = 0; a < 3; ++a) {
      cell[a] = hn::IfThenElseZero(hn::RebindMask(kI, inside), hn::Xor(r.cell[a], r.mirror[a]));
      const Floats mirror = hn::BitCast(kF, hn::ShiftLeft<31>(r.mirror[a]));
      place[a] = hn::Sub(hn::Xor(r.origin[a], mirror), hn::ConvertTo(kF, cell[a]));
      direction[a] = hn::Xor(r.direction[a], mirror);
    }
    const Corners corners = cells.corners(cells.offset(cell), r.isovalue);
    // The ray follows the level set that its start lies on; the isovalue may name it less precisely.
    const Floats off = value(corners, place);
    const Floats most = largest(corners);
    const Mask is_off = hn::Gt(hn::Abs(off), rounding(most, r.isovalue, zero));
    const Floats exact = hn::Max(hn::Add(hn::Xor(r.isovalue, cells.sign), off), hn::Set(kF, threshold));
    r.isovalue = hn::IfThenElse(is_off, hn::Xor(exact, cells.sign), r.isovalue);
    Deflated polynomial = deflated(corners, place, direction);
    polynomial.scale(to_unit(most));
    const Ints planes[3] = {hn::Add(r.cell[0], one), hn::Add(r.cell[1], one), hn::Add(r.cell[2], one)};
    const Exit exit = leave(r, planes);
    const Mask goes_on = in_box(exit.cell, r.mirror, cells.last_cell);
    // A level set may lie in the box's own face, where no next cell makes up for a rounding of the root.
    const Floats end_of_box = hn::Mul(exit.t, hn::Set(kF, 1.0f + 0x1p-20f));
    Floats root;
    const Mask blocked = hn::And(inside, goes_inwards(polynomial));
    const Mask again = next_root(polynomial, hn::IfThenElse(goes_on, exit.t, end_of_box), root);
    const Mask hit = hn::AndNot(blocked, hn::And(inside, again));
    const Floats noise = hn::Mul(rounding(most, r.isovalue, exit.t), to_unit(most));
    Mask doubtful = hn::And(inside, is_doubtful(polynomial, exit.t, noise));
    if (question == Question::kFirstHit) {
      const Mask is_sharp = hn::Le(noise, hn::Mul(hn::Set(kF, kAccuracy), slope_at_root(polynomial, root)));
      doubtful = hn::Or(doubtful, hn::AndNot(is_sharp, hit));
    }
    Mask proven = hn::FirstN(kF, 0);
    if (question == Question::kAnyHit) {
      proven = prover.prove(r, hn::AndNot(hn::Or(blocked, hit), inside));
      counters.proven += hn::CountTrue(kF, proven);
      doubtful = hn::AndNot(proven, doubtful);
    }
    if (!hn::AllFalse(kF, doubtful)) doubt(doubtful, r.id, rays);
    Floats t = hn::IfThenElse(hit, root, hn::Set(kF, kEscaped));
    if (question == Question::kAnyHit) t = hn::IfThenElse(hit, zero, t);
    hn::StoreU(hn::IfThenElse(hn::Or(blocked, proven), zero, t), kF, rays.t.data() + at);
    for (int a = 0; a < 3; ++a) r.cell[a] = exit.cell[a];
    r.t = exit.t;
    mark(r, stays_on_it(polynomial, exit.t, noise));
    const Mask answered = hn::Or(hn::Or(doubtful, proven), hn::Or(blocked, hit));
    append_lanes(travelling, r, hn::And(hn::AndNot(answered, inside), goes_on));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
