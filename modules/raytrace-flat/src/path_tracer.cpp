#include "path_tracer.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace isolux {
namespace {

double largest_component(const Vec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

PathTracer::PathTracer(const Volume& volume, const Scene& scene, const TraceSettings& settings,
                       const PathLimits& limits)
    : scene_(scene),
      settings_(settings),
      limits_(limits),
      march_(volume),
      field_(volume),
      world_to_index_(glm::inverse(volume.lattice().frame.axes)),
      environment_(scene.environment),
      lights_(scene.lights.begin(), scene.lights.end()) {}

Vec3 PathTracer::normal_at(const Vec3& position) const {
  const Vec3 normal = field_.normal(position, scene_.outer, settings_.gradient);
  if (normal != Vec3(0.0)) return normal;
  // Central differences can cancel where the cell itself still slopes.
  return field_.normal(position, scene_.outer, GradientKind::kCell);
}

bool PathTracer::is_visible(const Vertex& vertex, const Vec3& towards, double distance, TraceCounters& counters) const {
  return !march_.next_hit(vertex.position, world_to_index_ * towards, double(vertex.isovalue), scene_.outer,
                          RootWish::kExists, distance, counters);
}

Vec3 PathTracer::direct_light(const Vertex& vertex, const PathSampler& numbers, std::uint32_t path,
                              std::uint32_t dimension, TraceCounters& counters) const {
  constexpr double kInversePi = std::numbers::inv_pi;
  Vec3 sum(0.0);
  if (!lights_.empty()) {
    const Vec3 world = field_.lattice().frame.world(vertex.position);
    for (const PreparedLight& light : lights_) {
      const UnitPair pair = numbers.pair(path, dimension++);
      const auto sample = light.from(world).sample(pair.u, pair.v);
      if (!sample) continue;
      const double cosine = glm::dot(vertex.normal, sample->towards);
      if (cosine > 0.0 && is_visible(vertex, sample->towards, sample->distance, counters))
        sum += sample->weight * (cosine * kInversePi);
    }
  }
  if (environment_.has_samples()) {
    const UnitPair pair = numbers.pair(path, dimension);
    const auto sample = environment_.sample(pair.u, pair.v);
    const double cosine = glm::dot(vertex.normal, sample.towards);
    // The balance heuristic with the path's own cosine-distributed direction.
    if (cosine > 0.0 && is_visible(vertex, sample.towards, kInfinity, counters)) {
      const double density = cosine * kInversePi;
      sum += environment_.radiance(sample.towards) * (density / (density + sample.density));
    }
  }
  return sum;
}

Vec3 PathTracer::escaped_light(const Vertex& vertex, const Vec3& towards) const {
  const Vec3 radiance = environment_.radiance(towards);
  if (!environment_.has_samples()) return radiance;
  const double density = std::max(0.0, glm::dot(vertex.normal, towards)) * std::numbers::inv_pi;
  const double both = density + environment_.density(towards);
  return both > 0.0 ? radiance * (density / both) : Vec3(0.0);
}

Vec3 PathTracer::radiance(const Vec3& origin, const Vec3& normal, float isovalue, const PathSampler& numbers,
                          std::uint32_t path, UnitPair& first, TraceCounters& counters) const {
  const Vec3 albedo(scene_.albedo.at(isovalue));
  const Vec3 emission(scene_.emission.at(isovalue));
  const bool glows = emission != Vec3(0.0);
  const auto pairs_a_vertex = std::uint32_t(lights_.size()) + 3;
  Vertex vertex{.position = origin, .normal = normal, .frame = frame_about(normal), .isovalue = isovalue};
  Vec3 throughput(1.0);
  Vec3 sum(0.0);
  for (int depth = 0;; ++depth) {
    const std::uint32_t dimension = std::uint32_t(depth) * pairs_a_vertex;
    sum += throughput * direct_light(vertex, numbers, path, dimension + 2, counters);

    const UnitPair pair = numbers.pair(path, dimension);
    if (depth == 0) first = pair;
    const bool last = depth == settings_.bounces || depth == limits_.longest_path || albedo == Vec3(0.0);
    if (last && !glows && !environment_.shines()) return sum;
    const Vec3 towards = vertex.frame.world(cosine_direction(pair.u, pair.v));
    const auto hit = march_.next_hit(vertex.position, world_to_index_ * towards, double(isovalue), scene_.outer,
                                     last ? RootWish::kExists : RootWish::kPlace, kInfinity, counters);
    if (!hit) return sum + throughput * escaped_light(vertex, towards);
    sum += throughput * emission;
    counters.cut += std::uint64_t(depth == limits_.longest_path && depth != settings_.bounces);
    if (last) return sum;

    throughput *= albedo;
    if (depth >= limits_.roulette_depth) {
      const double survival = std::min(1.0, largest_component(throughput));
      if (numbers.pair(path, dimension + 1).u >= survival) return sum;
      throughput /= survival;
    }
    vertex.position = hit->position;
    vertex.normal = normal_at(vertex.position);
    if (vertex.normal == Vec3(0.0)) return sum;
    vertex.frame = frame_about(vertex.normal);
  }
}

}  // namespace isolux
