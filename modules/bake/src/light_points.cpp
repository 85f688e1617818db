#include <fmt/format.h>
#include <isolux/bake/light_points.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "bake_parts.h"
#include "checked_stages.h"
#include "residual_filter.h"
#include "standard_error.h"

namespace isolux {
namespace {

/// The points that have a normal.
struct SitesOfPoints {
  Sites sites;
  std::vector<std::size_t> point_of_site;
};

SitesOfPoints sites_of(const Volume& volume, const Scene& scene, std::span<const Vec3f> world_positions,
                       GradientKind gradient) {
  const TrilinearField field(volume);
  const Vec3f last(volume.lattice().size - 1);
  SitesOfPoints result;
  for (std::size_t i = 0; i < world_positions.size(); ++i) {
    if (!std::isfinite(glm::dot(world_positions[i], Vec3f(1.0f))))
      throw InvalidInput(fmt::format("point {} of {}: its coordinates are not finite", i, world_positions.size()));
    // Vertices on the box's faces are floats of the world: a rounding may put them outside, where no ray is blocked.
    const Vec3f position = glm::clamp(Vec3f(volume.lattice().frame.index(Vec3(world_positions[i]))), Vec3f(0.0f), last);
    const Vec3 normal = field.normal(Vec3(position), scene.outer, gradient);
    if (normal == Vec3(0.0)) continue;
    result.sites.positions.push_back(position);
    result.sites.isovalues.push_back(float(field.value(Vec3(position))));
    result.sites.normals.emplace_back(normal);
    result.point_of_site.push_back(i);
  }
  return result;
}

/// Replaces the samples' light by what `light` says and the smoothed rest.
void refine(SampleSet& samples, const LightReader& light, const Run& run) {
  const auto channels = std::size_t(samples.channels);
  const Sites& sites = samples.sites;
  std::vector<float> guess(samples.radiance.size());
  std::vector<float> residuals(samples.radiance.size());
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const Vec3f e = light.at_index(Vec3(sites.positions[s]), double(sites.isovalues[s]));
    for (std::size_t c = 0; c < channels; ++c) {
      guess[s * channels + c] = e[int(c)];
      residuals[s * channels + c] = samples.radiance[s * channels + c] - e[int(c)];
    }
  }
  FilteredResiduals filtered = filter_residuals(sites, residuals, samples.channels, samples.variance, run);
  for (std::size_t v = 0; v < guess.size(); ++v) {
    samples.radiance[v] = std::max(0.0f, guess[v] + filtered.residuals[v]);
  }
  samples.variance = std::move(filtered.variance);
}

PointLight trace_points(const Volume& volume, const Scene& scene, std::span<const Vec3f> world_positions,
                        const TraceSettings& settings, const BackendChoice& tracer, const Stages& stages,
                        const Run& run, const LightReader* guess) {
  (void)require_traceable(volume);
  const auto backend = checked_tracer(tracer, stages);
  SitesOfPoints points = sites_of(volume, scene, world_positions, settings.gradient);
  PointLight light;
  light.radiance.assign(world_positions.size(), Vec3f(0.0f));
  if (points.point_of_site.empty()) return light;
  TraceResult traced = backend->trace(volume, scene, std::move(points.sites), settings, run);
  light.counters = traced.counters;
  if (guess != nullptr) refine(traced.samples, *guess, run);
  const auto channels = std::size_t(traced.samples.channels);
  for (std::size_t s = 0; s < points.point_of_site.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) {
      light.radiance[points.point_of_site[s]][int(c)] = traced.samples.radiance[s * channels + (channels == 3 ? c : 0)];
    }
  }
  light.rmse_estimate = standard_error(traced.samples.variance);
  return light;
}

}  // namespace

PointLight light_points(const Volume& volume, const Scene& scene, std::span<const Vec3f> world_positions,
                        const TraceSettings& settings, const BackendChoice& tracer, const Stages& stages,
                        const Run& run) {
  return trace_points(volume, scene, world_positions, settings, tracer, stages, run, nullptr);
}

PointLight light_points(const Volume& volume, const Scene& scene, std::span<const Vec3f> world_positions,
                        const TraceSettings& settings, const BackendChoice& tracer, const Stages& stages,
                        const Run& run, const LightReader& light) {
  return trace_points(volume, scene, world_positions, settings, tracer, stages, run, &light);
}

}  // namespace isolux
