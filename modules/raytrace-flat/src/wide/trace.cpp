// Compiled once per instruction set; the fastest that the machine has is chosen when first called.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/trace.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, in this order.
#include <hwy/highway.h>

#include <memory>

#include "ray_march.h"
#include "wide/solve-inl.h"
#include "wide/start-inl.h"
#include "wide/test-inl.h"
#include "wide/travel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// What rays wait in between the stages.
struct Queues {
  RayQueue travelling;
  RayQueue waiting;
  RootQueue roots;
};

/// This thread's, made when it first traces: whatever threads hold from their start, those of the whole program have to
/// find room for on their stacks.
Queues& own_queues() {
  static thread_local const auto queues = std::make_unique<Queues>();
  return *queues;
}

/// Keeps the queue of travelling rays filled and lets the stages take turns until every ray has its answer.
template <Question question>
void run_stages(const FieldView& field, const OccupancyView& occupancy, const InnerView& inner, Rays& rays,
                TraceCounters& counters) {
  auto& [travelling, waiting, roots] = own_queues();
  const CellReader cells(field);
  Prover prover(field, inner);
  const Guide guide(occupancy, cells);
  const float threshold = field.outer == OuterSide::kLower ? occupancy.threshold : -occupancy.threshold;
  travelling.count = waiting.count = roots.count = 0;
  for (std::size_t next = 0; next < rays.count || travelling.count > 0;) {
    const std::size_t room = (RayQueue::kCapacity - travelling.count) / hn::Lanes(kF) * hn::Lanes(kF);
    const std::size_t end = HWY_MIN(rays.count, next + room);
    start<question>(cells, threshold, prover, rays, next, end, travelling, counters);
    // From the first rays of each batch alone, so that what is counted does not depend on threads.
    if (next == 0) prover.learn();
    next = end;
    travel(guide, travelling, waiting, counters);
    counters.cells += waiting.count;
    test<question>(cells, waiting, travelling, roots, rays);
    counters.cubics += roots.count;
    solve(roots, rays);
  }
  counters.rays += rays.count;
}

void trace_rays(const FieldView& field, const OccupancyView& occupancy, const InnerView& inner, Question question,
                Rays& rays, TraceCounters& counters) {
  if (question == Question::kAnyHit) {
    run_stages<Question::kAnyHit>(field, occupancy, inner, rays, counters);
  } else {
    run_stages<Question::kFirstHit>(field, occupancy, inner, rays, counters);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::wide {

HWY_EXPORT(trace_rays);

namespace {

/// Answers the doubtful and the vague rays in double precision.
void decide(const FieldView& field, Rays& rays, TraceCounters& counters) {
  const Lattice lattice{.size = field.size, .frame = {}};
  const RayMarch march(GridView<const float>(lattice, {field.values, lattice.count()}));
  TraceCounters extra;
  const auto ask = [&](std::uint32_t i, bool is_near) {
    const Vec3 origin(rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]);
    const Vec3 way(rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]);
    const auto isovalue = double(rays.isovalue[i]);
    std::optional<LevelSetHit> hit;
    if (is_near) hit = march.hit_in_cell(origin, way, isovalue, field.outer, double(rays.t[i]), extra);
    if (!hit) hit = march.next_hit(origin, way, isovalue, field.outer, RootWish::kPlace, kEscaped, extra);
    rays.t[i] = hit ? float(hit->t) : kEscaped;
  };
  for (const std::uint32_t i : rays.vague) ask(i, true);
  for (const std::uint32_t i : rays.doubtful) ask(i, false);
  counters.cells += extra.cells;
  counters.cubics += extra.cubics;
}

}  // namespace

void trace(const FieldView& field, const OccupancyView& occupancy, const InnerView& inner, Question question,
           Rays& rays, TraceCounters& counters) {
  rays.doubtful.clear();
  rays.vague.clear();
  HWY_DYNAMIC_DISPATCH(trace_rays)(field, occupancy, inner, question, rays, counters);
  decide(field, rays, counters);
}

}  // namespace isolux::wide
#endif
