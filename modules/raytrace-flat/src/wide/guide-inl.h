// What the occupancy tells a ray about the way ahead.
#if defined(ISOLUX_WIDE_GUIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_GUIDE_INL_H_
#undef ISOLUX_WIDE_GUIDE_INL_H_
#else
#define ISOLUX_WIDE_GUIDE_INL_H_
#endif

#include "wide/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

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

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
