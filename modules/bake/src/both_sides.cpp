#include "both_sides.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isolux {
namespace {

SideFigures figures(const BakeResult& side) {
  return {.sites = side.sites, .rays = side.counters.rays, .rmse_estimate = side.rmse_estimate};
}

}  // namespace

BakeResult both_sides(BakeResult outer, BakeResult inner) {
  outer.sides = {figures(outer), figures(inner)};
  outer.inner_light = std::move(inner.light);
  outer.inner_error = std::move(inner.error);
  add(outer.counters, inner.counters);
  outer.sites += inner.sites;
  outer.sweeps += inner.sweeps;
  outer.unlit_texels += inner.unlit_texels;
  outer.rmse_estimate = std::hypot(outer.rmse_estimate, inner.rmse_estimate) * std::sqrt(0.5);
  outer.noise = std::hypot(outer.noise, inner.noise) * std::sqrt(0.5);
  outer.reading_error = std::hypot(outer.reading_error, inner.reading_error) * std::sqrt(0.5);
  outer.least_rays = std::min(outer.least_rays, inner.least_rays);
  outer.most_rays = std::max(outer.most_rays, inner.most_rays);
  outer.link_bytes = std::max(outer.link_bytes, inner.link_bytes);  // one after the other
  for (const auto& [reason, count] : inner.skipped) outer.skipped[reason] += count;
  for (const auto& [stage, seconds] : inner.seconds) outer.seconds[stage] += seconds;
  return outer;
}

}  // namespace isolux
