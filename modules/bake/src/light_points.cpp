#include <isolux/bake/light_points.h>

#include <cmath>
#include <utility>

#include "standard_error.h"

namespace isolux {
namespace {

/// A mesh's vertices lie on grid edges, and the rounding of their world coordinates puts them beside: coordinates
/// within 1e-4 of a grid plane are put back on it. Elsewhere a shift of so little is beyond what the light tells.
Vec3f onto_grid(Vec3 index) {
  for (int a = 0; a < 3; ++a) {
    const double whole = std::round(index[a]);
    if (std::fabs(index[a] - whole) < 1e-4) index[a] = whole;
  }
  return Vec3f(index);
}

}  // namespace

PointLight light_points(const Volume& volume, const Scene& scene, std::span<const Vec3f> world_positions,
                        const TraceSettings& settings, const BackendChoice& tracer, const Stages& stages,
                        const Run& run) {
  require_usable(volume);
  const auto backend = stages.tracers.create(tracer.name, tracer.settings);
  const TrilinearField field(volume);
  Sites sites;
  std::vector<std::size_t> point_of_site;
  for (std::size_t i = 0; i < world_positions.size(); ++i) {
    const Vec3f position = onto_grid(volume.lattice().frame.index(Vec3(world_positions[i])));
    const Vec3 normal = field.normal(Vec3(position), scene.outer, settings.gradient);
    if (normal == Vec3(0.0)) continue;
    sites.positions.push_back(position);
    sites.isovalues.push_back(float(field.value(Vec3(position))));
    sites.normals.emplace_back(normal);
    point_of_site.push_back(i);
  }
  PointLight light;
  light.radiance.assign(world_positions.size(), Vec3f(0.0f));
  if (point_of_site.empty()) return light;
  const TraceResult traced = backend->trace(volume, scene, std::move(sites), settings, run);
  light.counters = traced.counters;
  const auto channels = std::size_t(traced.samples.channels);
  for (std::size_t s = 0; s < point_of_site.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) {
      light.radiance[point_of_site[s]][int(c)] = traced.samples.radiance[s * channels + (channels == 3 ? c : 0)];
    }
  }
  light.rmse_estimate = standard_error(traced.samples.variance);
  return light;
}

}  // namespace isolux
