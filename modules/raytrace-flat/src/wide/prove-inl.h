// Any-hit answers without a search: a ray that is seen on the inner side has met its level set.
#if defined(ISOLUX_WIDE_PROVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_PROVE_INL_H_
#undef ISOLUX_WIDE_PROVE_INL_H_
#else
#define ISOLUX_WIDE_PROVE_INL_H_
#endif

#include "wide/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// Looks for rays in cubes of inner values. The field is continuous: whoever comes from the level set's outer side into
/// such a cube has met the level set before, wherever that was, and a ray that starts inwards is blocked anyway.
class Prover {
 public:
  Prover(const FieldView& field, const InnerView& inner)
      : bits_(reinterpret_cast<const std::int32_t*>(inner.bits)),
        cubes_x_(hn::Set(kI, inner.cubes.x)),
        cubes_y_(hn::Set(kI, inner.cubes.y)),
        ceiling_(hn::Set(kF, inner.ceiling)),
        sign_(hn::Set(kF, field.outer == OuterSide::kLower ? 0.0f : -0.0f)) {
    for (int a = 0; a < 3; ++a) last_cube_[a] = hn::Set(kI, (field.size[a] - 1) / 2 - 1);
    // A place is wrong by less than 2^-23 of the volume's longest side, in cubes: two sums and a product.
    const int longest = HWY_MAX(field.size.x, HWY_MAX(field.size.y, field.size.z));
    surely_ = hn::Set(kF, 0.5f - 0x1p-21f * float(longest));
  }

  /// Lanes of `asked` that certainly meet their level set somewhere ahead.
  [[nodiscard]] HWY_INLINE Mask prove(const Lanes& lanes, Mask asked) {
    Mask proven = hn::FirstN(kF, 0);
    if (bits_ == nullptr) return proven;
    asked = hn::And(asked, hn::Le(hn::Xor(lanes.isovalue, sign_), ceiling_));
    const Line line = line_of(lanes);
    for (Group& group : groups_) {
      if (!group.pays) continue;
      if (hn::AllFalse(kF, asked)) break;
      Mask present = asked;
      Mask found = hn::FirstN(kF, 0);
      ISOLUX_UNROLL
      for (const float t : group.t) found = hn::Or(found, is_inside(line, hn::Set(kF, t), asked, present));
      ++group.looks;
      group.finds += hn::CountTrue(kF, found);
      proven = hn::Or(proven, found);
      asked = hn::AndNot(found, present);
    }
    return proven;
  }

  /// From here on looks only where it has found enough.
  void learn() {
    // Looking costs about a thirtieth of following a ray.
    for (Group& group : groups_) group.pays = 32 * group.finds >= hn::Lanes(kF) * group.looks;
  }

 private:
  /// A ray in units of cubes, not mirrored; whole numbers are the cubes' middles.
  struct Line {
    Floats origin[3];
    Floats direction[3];
  };

  /// Places that are looked at together: one does not wait for another's memory.
  struct Group {
    float t[4];  ///< in lengths of the direction, that is voxels
    bool pays = true;
    std::size_t looks = 0;  ///< vectors
    std::size_t finds = 0;  ///< rays
  };

  [[nodiscard]] static HWY_INLINE Line line_of(const Lanes& r) {
    Line line;
    const Floats half = hn::Set(kF, 0.5f);
    for (int a = 0; a < 3; ++a) {
      const Floats mirror = hn::BitCast(kF, hn::ShiftLeft<31>(r.mirror[a]));
      line.origin[a] = hn::Sub(hn::Mul(hn::Xor(r.origin[a], mirror), half), half);
      line.direction[a] = hn::Mul(hn::Xor(r.direction[a], mirror), half);
    }
    return line;
  }

  /// Lanes of `asked` that are in a cube of inner values at t, beyond the doubt of a rounding; `present` gets those
  /// that are in the volume there.
  [[nodiscard]] HWY_INLINE Mask is_inside(const Line& line, Floats t, Mask asked, Mask& present) const {
    const hn::RebindToUnsigned<IntTag> u;
    // As in floor_to_int; here the sum rounds to the nearest middle.
    const Floats shift = hn::Set(kF, 12582912.0f);
    Ints cube[3];
    Ints outside = hn::Zero(kI);
    Floats off = hn::Zero(kF);
    for (int a = 0; a < 3; ++a) {
      const Floats x = hn::MulAdd(t, line.direction[a], line.origin[a]);
      const Floats shifted = hn::Add(x, shift);
      off = hn::Max(off, hn::Abs(hn::Sub(x, hn::Sub(shifted, shift))));
      cube[a] = hn::Sub(hn::BitCast(kI, shifted), hn::BitCast(kI, shift));
      outside = hn::Or(outside, hn::Or(cube[a], hn::Sub(last_cube_[a], cube[a])));
    }
    present = hn::And(asked, float_mask(hn::Gt(outside, hn::Set(kI, -1))));
    const Ints row = hn::Add(hn::Mul(cube[2], cubes_y_), cube[1]);
    const Ints at = hn::IfThenElseZero(hn::RebindMask(kI, present), hn::Add(hn::Mul(row, cubes_x_), cube[0]));
    const auto word = hn::BitCast(u, hn::GatherIndex(kI, bits_, hn::ShiftRight<5>(at)));
    const auto bit = hn::BitCast(kI, hn::Shr(word, hn::BitCast(u, hn::And(at, hn::Set(kI, 31)))));
    const Mask inner = float_mask(hn::TestBit(bit, hn::Set(kI, 1)));
    return hn::And(hn::And(present, inner), hn::Le(off, surely_));
  }

  const std::int32_t* bits_;
  Ints cubes_x_;
  Ints cubes_y_;
  Ints last_cube_[3];
  Floats surely_;  ///< how near its middle a place surely lies in a cube
  Floats ceiling_;
  Floats sign_;  ///< sign bit set if isovalues are to be negated
  Group groups_[5] = {{{1.5f, 2.5f, 4.0f, 6.0f}},
                      {{8.0f, 11.0f, 15.0f, 20.0f}},
                      {{26.0f, 33.0f, 41.0f, 50.0f}},
                      {{60.0f, 75.0f, 90.0f, 110.0f}},
                      {{130.0f, 150.0f, 170.0f, 200.0f}}};
};

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
