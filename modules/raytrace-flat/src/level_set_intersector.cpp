#include <isolux/raytrace_flat/level_set_intersector.h>

#include "ray_march.h"

namespace isolux {

struct LevelSetIntersector::Impl {
  explicit Impl(const Volume& volume) : march(volume) {}
  RayMarch march;
};

LevelSetIntersector::LevelSetIntersector(const Volume& volume) : impl_(std::make_unique<Impl>(volume)) {}
LevelSetIntersector::~LevelSetIntersector() = default;

std::optional<LevelSetHit> LevelSetIntersector::next_hit(const Vec3& origin, const Vec3& direction, float isovalue,
                                                         OuterSide outer) const {
  TraceCounters counters;
  return impl_->march.next_hit(origin, direction, double(isovalue), outer, RootWish::kPlace,
                               std::numeric_limits<double>::infinity(), counters);
}

std::optional<LevelSetHit> LevelSetIntersector::first_hit(const Vec3& origin, const Vec3& direction,
                                                          float isovalue) const {
  TraceCounters counters;
  return impl_->march.first_hit(origin, direction, double(isovalue), counters);
}

bool LevelSetIntersector::is_occluded(const Vec3& origin, const Vec3& direction, float isovalue, OuterSide outer,
                                      double limit) const {
  TraceCounters counters;
  return impl_->march.next_hit(origin, direction, double(isovalue), outer, RootWish::kExists, limit, counters)
      .has_value();
}

}  // namespace isolux
