// Rays over level sets of small volumes of any values: the scalar intersector against a judge in long double that says
// when it cannot decide, and the wide kernels against the scalar intersector.
#include <isolux/raytrace_flat/flat_tracer.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/raytrace_flat/level_set_intersector.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "root_oracle.h"
#include "small_volume.h"

namespace {

using namespace isolux;
using fuzz::require;

constexpr double kNear = 1e-4;  ///< voxels: what the tracer's tests allow between two hits that are one

void check_scalar(const Volume& volume, const LevelSetIntersector& scalar, const Vec3& origin, const Vec3& direction,
                  float isovalue, OuterSide outer) {
  const auto hit = scalar.next_hit(origin, direction, isovalue, outer);
  require(hit.has_value() == scalar.is_occluded(origin, direction, isovalue, outer),
          "a shadow ray meets what a ray does");
  if (hit) require(hit->t >= 0.0 && std::isfinite(hit->t), "a hit lies on its ray");
  const test::OracleAnswer answer = test::RootOracle(volume).next_hit(origin, direction, outer);
  if (!answer.decided) return;
  require(hit.has_value() == answer.t.has_value(), "a ray meets its level set where it does");
  if (hit) require(std::abs(hit->t - *answer.t) * glm::length(direction) < kNear, "a ray meets its level set there");
}

Sites some_sites(fuzz::Bytes& bytes, const Volume& volume, OuterSide outer) {
  const TrilinearField field(volume);
  Sites sites;
  for (int i = 0; i < 4; ++i) {
    Vec3f place;
    for (int a = 0; a < 3; ++a)
      place[a] = float(bytes.next<std::uint16_t>()) / 65535.0f * float(volume.lattice().size[a] - 1);
    if (bytes.below(4) == 0) place = glm::round(place);
    const auto isovalue = float(field.value(Vec3(place)));
    const Vec3 normal = field.normal(Vec3(place), outer, GradientKind::kCentralDifferences);
    if (normal == Vec3(0.0)) continue;
    require(std::isfinite(isovalue) && std::abs(glm::length(normal) - 1.0) < 1e-5, "a site has a value and a normal");
    sites.positions.push_back(place);
    sites.isovalues.push_back(isovalue);
    sites.normals.emplace_back(normal);
  }
  return sites;
}

/// A level set that touches the box's own face is met by rays just as they leave: a matter of the last bit.
bool in_box_face(const Volume& volume, const Vec3& place) {
  const Vec3 last(volume.lattice().size - 1);
  const Vec3 margin = glm::min(place, last - place);
  return std::min({margin.x, margin.y, margin.z}) < 1e-6;
}

/// Under a sky of 1, surfaces that reflect at most all of it are nowhere brighter.
void check_light(const Volume& volume, const Sites& sites, OuterSide outer, const Run& run) {
  static const Registry<FlatTracer> registry = tracers();
  Scene scene;
  scene.outer = outer;
  for (const BackendInfo& info : registry.backends()) {
    const TraceResult result = registry.create(info.name)->trace(volume, scene, sites, {.rays = 4, .bounces = 3}, run);
    require(result.samples.radiance.size() == sites.size(), info.name + ": every site has its light");
    for (const float e : result.samples.radiance)
      require(e >= 0.0f && e <= 1.001f, info.name + ": light is not brighter than the sky");  // sums of some roundings
  }
}

/// Light does not depend on the unit of values from 2^-100 to 2^118 (docs/tracer.md); zero is there at any.
void bring_into_range(Volume& volume) {
  for (float& value : volume.values.values()) {
    if (std::abs(value) < 0x1p-100f) value = 0.0f;
    value = std::clamp(value, -0x1p117f, 0x1p117f);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes(data, size);
  const OuterSide outer = bytes.below(2) == 0 ? OuterSide::kLower : OuterSide::kHigher;
  const RayQuestion question = bytes.below(2) == 0 ? RayQuestion::kFirstHit : RayQuestion::kAnyHit;
  Run run = fuzz::alone();
  run.seed = bytes.next<std::uint16_t>();
  Volume volume = fuzz::small_volume(bytes, 5);
  bring_into_range(volume);
  if (fuzz::refused([&] { require_usable(volume); })) return 0;
  const Sites sites = some_sites(bytes, volume, outer);
  const LevelSetIntersector scalar(volume);
  (void)gather(volume, sites, {.rays = 16, .outer = outer, .question = question}, run, [&](const GatheredRays& rays) {
    for (std::size_t i = 0; i < rays.index_distance.size(); ++i) {
      const std::size_t site = rays.sites[i / rays.rays];
      const Vec3 origin(sites.positions[site]);
      const Vec3 way(rays.index_direction[0][i], rays.index_direction[1][i], rays.index_direction[2][i]);
      check_scalar(volume, scalar, origin, way, sites.isovalues[site], outer);
      const auto hit = scalar.next_hit(origin, way, sites.isovalues[site], outer);
      if (hit.has_value() == rays.escaped(i)) {
        const double t = hit ? hit->t : double(rays.index_distance[i]);
        require(in_box_face(volume, origin + t * way), "wide kernels hit where the scalar intersector does");
        continue;
      }
      if (hit && question == RayQuestion::kFirstHit)
        require(std::abs(hit->t - double(rays.index_distance[i])) * glm::length(way) <= kNear,
                "wide kernels hit at the place where the scalar intersector does");
    }
  });
  check_light(volume, sites, outer, run);
  return 0;
}
