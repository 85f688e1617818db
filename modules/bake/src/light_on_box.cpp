#include <fmt/format.h>
#include <isolux/bake/light_on_box.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <utility>
#include <vector>

#include "checked_stages.h"

namespace isolux {
namespace {

/// The box with nothing in it.
Volume empty_box(const Lattice& volume) {
  Lattice corners{.size = Index3(2), .frame = volume.frame};
  for (int a = 0; a < 3; ++a) corners.frame.axes[a] *= double(volume.size[a] - 1);
  Volume box;
  box.values = Grid<float>(corners);
  return box;
}

/// No level set of an empty box: all its values are 0.
constexpr float kNowhere = 1.0f;

void add_site(const Lattice& box, const Vec3f& world, const Vec3f& normal, Sites& sites) {
  const Vec3f index(box.frame.index(Vec3(world)));
  sites.positions.push_back(glm::clamp(index, Vec3f(0.0f), Vec3f(1.0f)));
  sites.isovalues.push_back(kNowhere);
  sites.normals.push_back(normal);
}

bool is_far(const Light& light) { return std::holds_alternative<SunLight>(light); }

/// The scene's environment and suns, or its other lights.
Scene part_of(Scene scene, bool far) {
  std::erase_if(scene.lights, [&](const Light& light) { return is_far(light) != far; });
  if (!far) scene.environment = UniformEnvironment{.radiance = Vec3f(0.0f)};
  return scene;
}

/// Which of the normals that differ each one is.
struct DistinctNormals {
  std::vector<Vec3f> normals;
  std::vector<std::size_t> of_point;

  explicit DistinctNormals(std::span<const Vec3f> all) {
    std::map<std::array<float, 3>, std::size_t> numbers;
    for (const Vec3f& n : all) {
      const auto [place, is_new] = numbers.try_emplace({n.x, n.y, n.z}, normals.size());
      if (is_new) normals.push_back(n);
      of_point.push_back(place->second);
    }
  }
};

Vec3f radiance_of(const SampleSet& samples, std::size_t site) {
  if (samples.channels == 1) return Vec3f(samples.radiance[site]);
  return {samples.radiance[3 * site], samples.radiance[3 * site + 1], samples.radiance[3 * site + 2]};
}

}  // namespace

PointLight light_on_box(const Lattice& volume, const Scene& scene, std::span<const Vec3f> positions,
                        std::span<const Vec3f> normals, const TraceSettings& settings, const BackendChoice& tracer,
                        const Stages& stages, const Run& run) {
  if (positions.size() != normals.size())
    throw InvalidInput(
        fmt::format("{} normals for {} positions: one a position is wanted", normals.size(), positions.size()));
  PointLight light;
  light.radiance.assign(positions.size(), Vec3f(0.0f));
  if (positions.empty()) return light;
  const auto backend = checked_tracer(tracer, stages);
  const Volume box = empty_box(volume);
  TraceSettings asked = settings;
  asked.bounces = 0;
  asked.values.reset();

  asked.rays = std::max(settings.rays, kRaysANormal);
  const DistinctNormals distinct(normals);
  Sites directions;
  for (const Vec3f& n : distinct.normals) add_site(box.lattice(), positions.front(), n, directions);
  const TraceResult far = backend->trace(box, part_of(scene, true), std::move(directions), asked, run);
  add(light.counters, far.counters);
  for (std::size_t i = 0; i < positions.size(); ++i) light.radiance[i] = radiance_of(far.samples, distinct.of_point[i]);
  if (std::all_of(scene.lights.begin(), scene.lights.end(), is_far)) return light;

  asked.rays = settings.rays;
  Sites places;
  for (std::size_t i = 0; i < positions.size(); ++i) add_site(box.lattice(), positions[i], normals[i], places);
  const TraceResult near = backend->trace(box, part_of(scene, false), std::move(places), asked, run);
  add(light.counters, near.counters);
  for (std::size_t i = 0; i < positions.size(); ++i) light.radiance[i] += radiance_of(near.samples, i);
  return light;
}

namespace {

constexpr int kMostPoints = 257;  // of a face along an axis

}  // namespace

BoxLight::BoxLight(const Lattice& volume, const Scene& scene, const TraceSettings& settings,
                   const BackendChoice& tracer, const Stages& stages, const Run& run)
    : last_(volume.size - 1) {
  const bool is_even = std::all_of(scene.lights.begin(), scene.lights.end(), is_far);
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    auto& points = faces_[std::size_t(face)].points;
    points = {is_even ? 1 : std::min(volume.size[u], kMostPoints), is_even ? 1 : std::min(volume.size[v], kMostPoints)};
    const Vec3 upwards = glm::normalize(volume.frame.gradient_to_world()[axis]);
    const Vec3f normal(face % 2 == 0 ? -upwards : upwards);
    Vec3 index(0.0);
    index[axis] = face % 2 == 0 ? 0.0 : last_[axis];
    for (int j = 0; j < points[1]; ++j)
      for (int i = 0; i < points[0]; ++i) {
        index[u] = double(last_[u]) * i / std::max(1, points[0] - 1);
        index[v] = double(last_[v]) * j / std::max(1, points[1] - 1);
        positions.emplace_back(volume.frame.world(index));
        normals.push_back(normal);
      }
  }
  const PointLight light = light_on_box(volume, scene, positions, normals, settings, tracer, stages, run);
  counters_ = light.counters;
  auto next = light.radiance.begin();
  for (Face& face : faces_) {
    const auto end = next + std::ptrdiff_t(face.points[0]) * face.points[1];
    face.radiance.assign(next, end);
    next = end;
  }
}

Vec3f BoxLight::at(int face, const Vec3& index) const {
  const std::array<int, 2>& points = faces_[std::size_t(face)].points;
  const std::vector<Vec3f>& radiance = faces_[std::size_t(face)].radiance;
  std::array<std::size_t, 2> low{};
  std::array<std::size_t, 2> high{};
  std::array<float, 2> part{};
  for (std::size_t a = 0; a < 2; ++a) {
    const int axis = (face / 2 + 1 + int(a)) % 3;
    const double place = std::clamp(index[axis] / last_[axis], 0.0, 1.0) * (points[a] - 1);
    low[a] = std::size_t(place);
    high[a] = std::min(low[a] + 1, std::size_t(points[a] - 1));
    part[a] = float(place - double(low[a]));
  }
  const auto of = [&](std::size_t i, std::size_t j) { return radiance[j * std::size_t(points[0]) + i]; };
  return glm::mix(glm::mix(of(low[0], low[1]), of(high[0], low[1]), part[0]),
                  glm::mix(of(low[0], high[1]), of(high[0], high[1]), part[0]), part[1]);
}

}  // namespace isolux
