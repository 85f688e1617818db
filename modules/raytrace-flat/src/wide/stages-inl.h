// The stages of the stream: start -> travel -> test -> solve. Included once per instruction set.
#if defined(ISOLUX_WIDE_STAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_STAGES_INL_H_
#undef ISOLUX_WIDE_STAGES_INL_H_
#else
#define ISOLUX_WIDE_STAGES_INL_H_
#endif

#include <hwy/cache_control.h>

#include <bit>

#include "wide/cell-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// Components below this are taken for this: their planes are then beyond every box, and 1/d stays finite.
inline constexpr float kSmallestDirection = 1e-12f;

/// Roots that rounding may shift by more are asked of double precision: in voxels, some of what is promised.
inline constexpr float kAccuracy = 4e-5f;

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

/// Calls body with the number of each lane's ray.
template <class Body>
HWY_INLINE void for_each_ray(Mask mask, Ints id, const Body& body) {
  alignas(64) std::int32_t number[hn::MaxLanes(kI)];
  hn::Store(number_of(id), kI, number);
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(kF, mask, bytes);
  for (unsigned bits = bytes[0] | unsigned(bytes[1]) << 8; bits != 0; bits &= bits - 1)
    body(std::size_t(number[std::countr_zero(bits)]));
}

HWY_INLINE void doubt(Mask mask, Ints id, Rays& rays) {
  for_each_ray(mask, id, [&](std::size_t ray) { rays.doubtful.push_back(std::uint32_t(ray)); });
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
void start(const CellReader& cells, float threshold, Rays& rays, std::size_t begin, std::size_t end,
           RayQueue& travelling) {
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
    const Mask is_off = hn::Gt(hn::Abs(off), rounding(corners, r.isovalue, zero));
    const Floats exact = hn::Max(hn::Add(hn::Xor(r.isovalue, cells.sign), off), hn::Set(kF, threshold));
    r.isovalue = hn::IfThenElse(is_off, hn::Xor(exact, cells.sign), r.isovalue);
    const Deflated polynomial = deflated(corners, place, direction);
    const Ints planes[3] = {hn::Add(r.cell[0], one), hn::Add(r.cell[1], one), hn::Add(r.cell[2], one)};
    const Exit exit = leave(r, planes);
    const Mask goes_on = in_box(exit.cell, r.mirror, cells.last_cell);
    // A level set may lie in the box's own face, where no next cell makes up for a rounding of the root.
    const Floats end_of_box = hn::Mul(exit.t, hn::Set(kF, 1.0f + 0x1p-20f));
    Floats root;
    const Mask blocked = hn::And(inside, goes_inwards(polynomial));
    const Mask again = next_root(polynomial, hn::IfThenElse(goes_on, exit.t, end_of_box), root);
    const Mask hit = hn::AndNot(blocked, hn::And(inside, again));
    const Floats noise = rounding(corners, r.isovalue, exit.t);
    Mask doubtful = hn::And(inside, is_doubtful(polynomial, exit.t, noise));
    if (question == Question::kFirstHit) {
      const Mask is_sharp = hn::Le(noise, hn::Mul(hn::Set(kF, kAccuracy), slope_at_root(polynomial, root)));
      doubtful = hn::Or(doubtful, hn::AndNot(is_sharp, hit));
    }
    if (!hn::AllFalse(kF, doubtful)) doubt(doubtful, r.id, rays);
    Floats t = hn::IfThenElse(hit, root, hn::Set(kF, kEscaped));
    if (question == Question::kAnyHit) t = hn::IfThenElse(hit, zero, t);
    hn::StoreU(hn::IfThenElse(blocked, zero, t), kF, rays.t.data() + at);
    for (int a = 0; a < 3; ++a) r.cell[a] = exit.cell[a];
    r.t = exit.t;
    mark(r, stays_on_it(polynomial, exit.t, noise));
    const Mask answered = hn::Or(doubtful, hn::Or(blocked, hit));
    append_lanes(travelling, r, hn::And(hn::AndNot(answered, inside), goes_on));
  }
}

/// Finds how far a ray may leap from where it stands.
struct Guide {
  const std::int32_t* words;
  Ints bricks_x;
  Ints bricks_xy;
  Ints last_cell[3];

  Guide(const OccupancyView& occupancy, const CellReader& cells)
      : words(reinterpret_cast<const std::int32_t*>(occupancy.words)),
        bricks_x(hn::Set(kI, occupancy.bricks.x)),
        bricks_xy(hn::Set(kI, occupancy.bricks.x * occupancy.bricks.y)) {
    for (int a = 0; a < 3; ++a) last_cell[a] = cells.last_cell[a];
  }

  /// What is known of the half brick in which a ray stands, and where in the brick it stands.
  struct Sight {
    Ints word;
    Ints cell[3];  ///< not mirrored
  };

  [[nodiscard]] HWY_INLINE Sight look(const Lanes& r, Mask moving) const {
    Sight sight;
    for (int a = 0; a < 3; ++a) sight.cell[a] = hn::Xor(r.cell[a], r.mirror[a]);
    const auto& x = sight.cell;
    const Ints row = hn::Add(hn::Mul(hn::ShiftRight<2>(x[2]), bricks_xy), hn::Mul(hn::ShiftRight<2>(x[1]), bricks_x));
    const Ints brick = hn::Add(row, hn::ShiftRight<2>(x[0]));
    const Ints half = hn::And(hn::ShiftRight<1>(x[2]), hn::Set(kI, 1));
    const Ints at = hn::Add(hn::Add(brick, brick), half);
    sight.word = hn::GatherIndex(kI, words, hn::IfThenElseZero(hn::RebindMask(kI, moving), at));
    return sight;
  }

  /// The bits of the cells of a half brick that a ray may still pass.
  [[nodiscard]] HWY_INLINE Ints ahead(const Lanes& r, const Sight& sight) const {
    const hn::RebindToUnsigned<IntTag> u;
    const Ints three = hn::Set(kI, 3);
    const Ints all = hn::Set(kI, -1);
    // Forwards the places from k = i on, backwards those that are not from k = i + 1 on.
    const auto from = [&](int a, Ints shift) {
      return hn::Xor(hn::BitCast(kI, hn::Shl(hn::BitCast(u, all), hn::BitCast(u, shift))), r.mirror[a]);
    };
    const Ints k_x = hn::Sub(hn::And(sight.cell[0], three), r.mirror[0]);
    const Ints k_y = hn::ShiftLeft<2>(hn::Sub(hn::And(sight.cell[1], three), r.mirror[1]));
    const Ints x = hn::Mul(hn::And(from(0, k_x), hn::Set(kI, 0xF)), hn::Set(kI, 0x11111111));
    const Ints rows = from(1, k_y);
    const Ints y = hn::Or(hn::And(rows, hn::Set(kI, 0xFFFF)), hn::ShiftLeft<16>(rows));
    const auto in_first_layer = hn::Eq(hn::And(r.cell[2], hn::Set(kI, 1)), hn::Zero(kI));
    const Ints z = hn::Or(hn::VecFromMask(kI, in_first_layer), hn::Xor(hn::Set(kI, -0x10000), r.mirror[2]));
    return hn::And(x, hn::And(y, z));
  }

  /// Moves the lanes of `moving` to the end of the empty box around them: the cube of bricks, else what is left of the
  /// half brick, else the cell. Returns the lanes that stand in an occupied cell instead; those that left the volume
  /// are taken from `moving` too.
  [[nodiscard]] HWY_INLINE Mask move(Lanes& r, Ints octant, const Sight& sight, Mask& moving) const {
    const hn::RebindToUnsigned<IntTag> u;
    const Ints zero = hn::Zero(kI);
    const Ints one = hn::Set(kI, 1);
    const Ints three = hn::Set(kI, 3);
    const auto bits = hn::BitCast(u, sight.word);
    const Ints bit = hn::Or(hn::ShiftLeft<4>(hn::And(sight.cell[2], one)),
                            hn::Or(hn::ShiftLeft<2>(hn::And(sight.cell[1], three)), hn::And(sight.cell[0], three)));
    const Ints upper = hn::And(sight.word, hn::Set(kI, std::int32_t(kUpperByte)));
    const auto empty_brick = hn::Eq(upper, hn::Set(kI, std::int32_t(kEmptyBrick)));
    const auto in_cell = hn::TestBit(hn::BitCast(kI, hn::Shr(bits, hn::BitCast(u, bit))), one);
    const auto occupied = hn::AndNot(empty_brick, in_cell);
    const auto empty_rest = hn::Or(hn::Eq(hn::And(sight.word, ahead(r, sight)), zero), empty_brick);
    const Ints code = hn::And(hn::BitCast(kI, hn::Shr(bits, hn::BitCast(u, octant))), hn::Set(kI, 7));
    const Ints cube = hn::Add(code, hn::Max(hn::Sub(code, three), zero));
    const Ints rest = hn::IfThenElseZero(empty_rest, three);
    const Ints rest_z = hn::IfThenElse(empty_brick, three, hn::IfThenElseZero(empty_rest, one));
    const Ints more = hn::Add(one, hn::IfThenElseZero(empty_brick, hn::ShiftLeft<2>(cube)));
    const Ints plane[3] = {hn::Add(hn::Or(r.cell[0], rest), more), hn::Add(hn::Or(r.cell[1], rest), more),
                           hn::Add(hn::Or(r.cell[2], rest_z), more)};
    const Exit exit = leave(r, plane);
    const Mask stopped = hn::And(moving, float_mask(occupied));
    moving = hn::AndNot(stopped, moving);
    const auto go = hn::RebindMask(kI, moving);
    for (int a = 0; a < 3; ++a) r.cell[a] = hn::IfThenElse(go, exit.cell[a], r.cell[a]);
    r.t = hn::IfThenElse(moving, exit.t, r.t);
    moving = hn::And(moving, in_box(r.cell, r.mirror, last_cell));
    return stopped;
  }
};

/// Where the leaps of a ray's octant are kept in a word.
HWY_INLINE Ints octant_shift(const Lanes& r) {
  return hn::Add(hn::And(r.mirror[0], hn::Set(kI, 3)),
                 hn::Add(hn::And(r.mirror[1], hn::Set(kI, 6)), hn::And(r.mirror[2], hn::Set(kI, 12))));
}

/// Hands on a vector of rays that have travelled: lanes of `stopped` to `waiting`, those of `moving` back to their own
/// queue. What has not changed goes from memory to memory. Only lanes of `fresh` may still lie on their level set:
/// whoever has leapt over an empty cell has left it. \pre the queue's end is not beyond `at`
HWY_INLINE void sort_lanes(RayQueue& travelling, std::size_t at, const Lanes& r, Mask stopped, Mask fresh, Mask moving,
                           RayQueue& waiting) {
  const Packing to_waiting(stopped);
  const Packing to_travelling(moving);
  const std::size_t end = travelling.count;
  const std::size_t wait = waiting.count;
  const auto hand_on = [&](std::size_t field, Floats v) HWY_ATTR {
    to_waiting.store(v, waiting.field[field] + wait);
    to_travelling.store(v, travelling.field[field] + end);
  };
  const auto unchanged = [&](std::size_t field) HWY_ATTR { return hn::LoadU(kF, travelling.field[field] + at); };
  for (std::size_t field = 0; field < 6; ++field) hand_on(field, unchanged(field));
  for (std::size_t a = 0; a < 3; ++a) hand_on(6 + a, hn::BitCast(kF, r.cell[a]));
  hand_on(9, r.t);
  hand_on(10, unchanged(10));
  const Ints id = hn::BitCast(kI, unchanged(11));
  hand_on(11, hn::BitCast(kF, hn::IfThenElse(hn::RebindMask(kI, fresh), id, number_of(id))));
  waiting.count += to_waiting.count();
  travelling.count += to_travelling.count();
}

/// Second stage, one pass over the queue: a few steps for each pair of vectors of rays, without branches; rays that
/// reach an occupied cell go to `waiting`, those that leave the volume are done, the rest is packed again.
void travel(const Guide& guide, RayQueue& travelling, RayQueue& waiting, TraceCounters& counters) {
  constexpr int kSteps = 2;
  constexpr std::size_t kVectors = 2;  // while one waits for memory the other moves
  const std::size_t lanes = hn::Lanes(kF);
  const std::size_t count = travelling.count;
  travelling.count = 0;
  for (std::size_t at = 0; at < count; at += kVectors * lanes) {
    Lanes r[kVectors];
    Mask moving[kVectors];
    Mask stopped[kVectors];
    Mask fresh[kVectors];
    Ints octant[kVectors];
    ISOLUX_UNROLL
    for (std::size_t v = 0; v < kVectors; ++v) {
      r[v] = load_lanes(travelling, at + v * lanes);
      octant[v] = octant_shift(r[v]);
      moving[v] = hn::FirstN(kF, count - HWY_MIN(count, at + v * lanes));
      stopped[v] = hn::FirstN(kF, 0);
    }
    ISOLUX_UNROLL
    for (int step = 0; step < kSteps; ++step) {
      Guide::Sight sight[kVectors];
      ISOLUX_UNROLL
      for (std::size_t v = 0; v < kVectors; ++v) sight[v] = guide.look(r[v], moving[v]);
      ISOLUX_UNROLL
      for (std::size_t v = 0; v < kVectors; ++v) {
        counters.macrocells += hn::CountTrue(kF, moving[v]);
        stopped[v] = hn::Or(stopped[v], guide.move(r[v], octant[v], sight[v], moving[v]));
        if (step == 0) fresh[v] = stopped[v];
      }
    }
    ISOLUX_UNROLL
    for (std::size_t v = 0; v < kVectors; ++v)
      sort_lanes(travelling, at + v * lanes, r[v], stopped[v], fresh[v], moving[v], waiting);
  }
}

/// Cubics with a root, waiting for the last stage.
struct RootQueue {
  alignas(64) float b[4][RayQueue::kCapacity + 2 * kPadding];
  alignas(64) float high[RayQueue::kCapacity + 2 * kPadding];
  alignas(64) float noise[RayQueue::kCapacity + 2 * kPadding];  ///< of the cubic's values
  alignas(64) float t_enter[RayQueue::kCapacity + 2 * kPadding];
  alignas(64) float t_leave[RayQueue::kCapacity + 2 * kPadding];
  alignas(64) float id[RayQueue::kCapacity + 2 * kPadding];
  std::size_t count = 0;

  [[nodiscard]] std::size_t ray(std::size_t at) const { return std::size_t(std::bit_cast<std::int32_t>(id[at])); }
};

HWY_INLINE void append_roots(RootQueue& roots, const Cubic& cubic, Floats high, Floats noise, Ints id, Floats t_enter,
                             Floats t_leave, Mask mask) {
  const Packing packing(mask);
  const std::size_t at = roots.count;
  for (int i = 0; i < 4; ++i) packing.store(cubic.b[i], roots.b[i] + at);
  packing.store(high, roots.high + at);
  packing.store(noise, roots.noise + at);
  packing.store(t_enter, roots.t_enter + at);
  packing.store(t_leave, roots.t_leave + at);
  packing.store(hn::BitCast(kF, number_of(id)), roots.id + at);
  roots.count += packing.count();
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
    const Cubic cubic = along(corners, from, to);
    // Reached already at the entry: the root lies on the face, on the last cell's side by rounding.
    const Mask at_entry = hn::And(present, hn::Ge(cubic.b[0], zero));
    Floats high;
    const Floats noise = rounding(corners, r.isovalue, exit.t);
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

/// Last stage: solves the queued cubics. Where rounding may shift a root by more than the accuracy promised (a ray that
/// grazes its level set) the hit is vague.
void solve(RootQueue& roots, Rays& rays) {
  alignas(64) float t[hn::MaxLanes(kF)];
  const std::size_t lanes = hn::Lanes(kF);
  for (std::size_t at = 0; at < roots.count; at += lanes) {
    Cubic cubic;
    for (int i = 0; i < 4; ++i) cubic.b[i] = hn::LoadU(kF, roots.b[i] + at);
    const Floats high = hn::LoadU(kF, roots.high + at);
    const Floats enter = hn::LoadU(kF, roots.t_enter + at);
    const Floats leave_at = hn::LoadU(kF, roots.t_leave + at);
    const Mask known = hn::Le(high, hn::Zero(kF));
    const Floats s = hn::IfThenZeroElse(known, bracketed_root(cubic, high));
    hn::Store(lerp(enter, leave_at, s), kF, t);
    const std::size_t n = HWY_MIN(lanes, roots.count - at);
    for (std::size_t i = 0; i < n; ++i) rays.t[roots.ray(at + i)] = t[i];
    // Newton's steps are slow where the ray nearly touches: what they left counts, too.
    const Floats off = hn::Add(hn::LoadU(kF, roots.noise + at), hn::Abs(value(cubic, s)));
    const Floats shift = hn::Mul(off, hn::Sub(leave_at, enter));
    const Mask sure = hn::Or(known, hn::Le(shift, hn::Mul(slope(cubic, s), hn::Set(kF, kAccuracy))));
    const Mask unsure = hn::AndNot(sure, hn::FirstN(kF, n));
    for_each_ray(unsure, load_ints(roots.id + at), [&](std::size_t ray) { rays.vague.push_back(std::uint32_t(ray)); });
  }
  roots.count = 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
