// Second stage: leaps to the next occupied cell.
#if defined(ISOLUX_WIDE_TRAVEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_TRAVEL_INL_H_
#undef ISOLUX_WIDE_TRAVEL_INL_H_
#else
#define ISOLUX_WIDE_TRAVEL_INL_H_
#endif

#include "wide/guide-inl.h"
#include "wide/queue-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

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

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#endif
