// The queue of rays between the stages, and how lanes of a vector are packed into it.
#if defined(ISOLUX_WIDE_QUEUE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_QUEUE_INL_H_
#undef ISOLUX_WIDE_QUEUE_INL_H_
#else
#define ISOLUX_WIDE_QUEUE_INL_H_
#endif

#include <bit>

#include "wide/lanes-inl.h"
#include "wide/pack_order.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// Rays on their way between two stages; structure of arrays.
struct RayQueue {
  static constexpr std::size_t kCapacity = 1024;
  static constexpr std::size_t kFields = 12;

  alignas(64) float field[kFields][kCapacity + 2 * kPadding];
  std::size_t count = 0;

  [[nodiscard]] bool room_for(std::size_t rays) const { return count + rays <= kCapacity; }
};

HWY_INLINE Ints load_ints(const float* from) { return hn::BitCast(kI, hn::LoadU(kF, from)); }

HWY_INLINE Lanes load_lanes(const RayQueue& queue, std::size_t at) {
  Lanes r;
  for (int a = 0; a < 3; ++a) {
    r.origin[a] = hn::LoadU(kF, queue.field[a] + at);
    const Floats signed_direction = hn::LoadU(kF, queue.field[3 + a] + at);
    r.direction[a] = hn::Abs(signed_direction);
    r.inverse[a] = hn::Div(hn::Set(kF, 1.0f), r.direction[a]);
    r.mirror[a] = hn::BroadcastSignBit(hn::BitCast(kI, signed_direction));
    r.cell[a] = load_ints(queue.field[6 + a] + at);
  }
  r.t = hn::LoadU(kF, queue.field[9] + at);
  r.isovalue = hn::LoadU(kF, queue.field[10] + at);
  r.id = load_ints(queue.field[11] + at);
  return r;
}

/// Packs the lanes of a mask to the front of vectors. (Highway's CompressStore looks the permutation up again for each
/// vector, and release 1.0 with GCC 12 copies its table to the stack each time: a quarter of this speed.)
class Packing {
 public:
  explicit HWY_INLINE Packing(Mask mask) : count_(hn::CountTrue(kF, mask)), mask_(mask) {
#if HWY_TARGET != HWY_AVX3
    static_assert(hn::MaxLanes(kI) <= 8);
    std::uint8_t bits[8];
    hn::StoreMaskBits(kF, mask, bits);
    const hn::Rebind<std::uint8_t, IntTag> bytes;
    order_ = hn::IndicesFromVec(kF, hn::PromoteTo(kI, hn::LoadU(bytes, kPackOrder[bits[0]].data())));
#endif
  }
  [[nodiscard]] HWY_INLINE std::size_t count() const { return count_; }
  /// Writes a whole vector, the packed lanes first.
  HWY_INLINE void store(Floats v, float* to) const {
#if HWY_TARGET == HWY_AVX3
    hn::StoreU(hn::Compress(v, mask_), kF, to);
#else
    hn::StoreU(hn::TableLookupLanes(v, order_), kF, to);
#endif
  }

 private:
  std::size_t count_;
  Mask mask_;
#if HWY_TARGET != HWY_AVX3
  decltype(hn::IndicesFromVec(kF, hn::Zero(kI))) order_;
#endif
};

/// Appends the lanes of `mask`, packed. Whole vectors are stored: what lies behind the end of the queue is overwritten.
HWY_INLINE void append_lanes(RayQueue& queue, const Lanes& r, Mask mask) {
  const Packing packing(mask);
  const std::size_t at = queue.count;
  for (int a = 0; a < 3; ++a) {
    const Floats sign = hn::BitCast(kF, hn::ShiftLeft<31>(r.mirror[a]));
    packing.store(r.origin[a], queue.field[a] + at);
    packing.store(hn::Or(r.direction[a], sign), queue.field[3 + a] + at);
    packing.store(hn::BitCast(kF, r.cell[a]), queue.field[6 + a] + at);
  }
  packing.store(r.t, queue.field[9] + at);
  packing.store(r.isovalue, queue.field[10] + at);
  packing.store(hn::BitCast(kF, r.id), queue.field[11] + at);
  queue.count += packing.count();
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

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
