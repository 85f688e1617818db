#include "vertex_light.h"

#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/bake/light_on_box.h>
#include <isolux/bake/light_points.h>
#include <isolux/mc_extract/cap_vertices.h>
#include <isolux/render/image.h>
#include <isolux/resample/light_reader.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace isolux {
namespace {

/// Numbers of vertices and, in the same order, where they are.
struct VertexPlaces {
  std::vector<std::uint32_t> vertices;
  std::vector<Vec3f> positions;

  void add(const IsoMesh& mesh, std::uint32_t vertex) {
    const auto& p = mesh.point(OpenMesh::VertexHandle(int(vertex)));
    vertices.push_back(vertex);
    positions.emplace_back(p[0], p[1], p[2]);
  }
  /// Gives each of them its e.
  void assign(const std::vector<Vec3f>& radiance, std::vector<Vec3f>& e) const {
    for (std::size_t i = 0; i < vertices.size(); ++i) e[vertices[i]] = radiance[i];
  }
};

struct SurfaceAndCap {
  VertexPlaces surface;
  VertexPlaces cap;
};

SurfaceAndCap parts_of(const IsoMesh& mesh, const Lattice& volume, bool is_capped) {
  SurfaceAndCap parts;
  std::vector<std::uint32_t> cap;
  if (is_capped) cap = cap_vertices(mesh, volume);
  auto next = cap.begin();
  for (std::uint32_t v = 0; v < mesh.n_vertices(); ++v) {
    const bool is_of_cap = next != cap.end() && *next == v;
    (is_of_cap ? parts.cap : parts.surface).add(mesh, v);
    if (is_of_cap) ++next;
  }
  return parts;
}

/// Light traced at points, with a baked one as control variate if there is one of their level set.
PointLight exact_light(const std::vector<Vec3f>& positions, const Volume& volume, const Scene& scene,
                       const std::optional<LightFile>& baked, const ExtractOptions& options, Session& session) {
  const BackendChoice tracer{options.trace.tracer(), {}};
  TraceSettings settings = options.trace.settings();
  if (baked && !options.trace.bounces_given()) settings.bounces = light_bounces(*baked);
  if (!baked || !baked->grid.detail.covers(double(options.isovalue)))
    return light_points(volume, scene, positions, settings, tracer, session.stages, session.run);
  const IlluminationGrid& grid = options.light.of_side(*baked, side_towards(*baked, scene.outer));
  const LightReader reader(volume, grid, TexelStorage::kBricks, session.run);
  return light_points(volume, scene, positions, settings, tracer, session.stages, session.run, reader);
}

std::vector<Vec3f> baked_light(const std::vector<Vec3f>& positions, const Volume& volume, const LightFile& light,
                               OuterSide outer, const ExtractOptions& options, const Run& run) {
  const IlluminationGrid& grid = options.light.of_side(light, side_towards(light, outer));
  const LightReader reader(volume, grid, TexelStorage::kBricks, run);
  std::vector<Vec3f> radiance;
  radiance.reserve(positions.size());
  for (const Vec3f& p : positions)
    radiance.push_back(reader.at_index(volume.lattice().frame.index(Vec3(p)), double(options.isovalue)));
  return radiance;
}

/// Whose light a cap beside baked light is in.
Scene scene_of_cap(const LightFile& baked, const ExtractOptions& options, const Session& session) {
  if (options.trace.scene_given()) return options.trace.scene();
  if (const auto scene = light_scene(baked)) return *scene;
  session.warn(
      "--cap: the light does not tell its whole scene, so the cap is lit by a white sky; give it with --scene");
  return {};
}

PointLight cap_light(const VertexPlaces& cap, const IsoMesh& mesh, const Lattice& volume, const Scene& scene,
                     const ExtractOptions& options, const Session& session) {
  std::vector<Vec3f> normals;
  normals.reserve(cap.vertices.size());
  for (const std::uint32_t v : cap.vertices) {
    const auto& n = mesh.normal(OpenMesh::VertexHandle(int(v)));
    normals.emplace_back(n[0], n[1], n[2]);
  }
  return light_on_box(volume, scene, cap.positions, normals, options.trace.settings(), {options.trace.tracer(), {}},
                      session.stages, session.run);
}

}  // namespace

VertexLight vertex_light(const IsoMesh& mesh, const Volume& volume, const Scene& scene,
                         const std::optional<LightFile>& baked, OuterSide outer, const ExtractOptions& options,
                         Session& session) {
  VertexLight result;
  result.e.assign(mesh.n_vertices(), Vec3f(0.0f));
  const SurfaceAndCap parts = parts_of(mesh, volume.lattice(), options.cap);
  std::uint64_t rays = 0;
  if (options.exact_light) {
    const PointLight light = session.timed(
        "trace", [&] { return exact_light(parts.surface.positions, volume, scene, baked, options, session); });
    parts.surface.assign(light.radiance, result.e);
    result.surface = surface_colour(scene, options.isovalue);
    result.channels = is_grey(scene) ? 1 : 3;
    rays = light.counters.rays;
    session.report["rmse_estimate"] = light.rmse_estimate;
  } else {
    parts.surface.assign(
        session.timed(
            "light", [&] { return baked_light(parts.surface.positions, volume, *baked, outer, options, session.run); }),
        result.e);
    result.surface = surface_colour(*baked, options.isovalue);
    result.channels = baked->grid.channels;
  }
  if (!parts.cap.vertices.empty()) {
    const Scene lit = options.exact_light ? scene : scene_of_cap(*baked, options, session);
    const PointLight light =
        session.timed("trace", [&] { return cap_light(parts.cap, mesh, volume.lattice(), lit, options, session); });
    parts.cap.assign(light.radiance, result.e);
    if (!is_grey(lit)) result.channels = 3;
    rays += light.counters.rays;
  }
  if (rays > 0 || options.exact_light) session.report["rays"] = rays;
  return result;
}

std::vector<Rgb8> shown_colours(const VertexLight& light, double exposure, const Session& session) {
  constexpr float kWhite = 1.0f + 0.5f / 112.0f;  // half a code beyond 255, where sRGB has 112 codes a unit
  const auto factor = float(std::exp2(exposure));
  std::vector<Rgb8> colours;
  colours.reserve(light.e.size());
  std::size_t too_bright = 0;
  float brightest = 0.0f;
  for (const Vec3f& e : light.e) {
    const Vec3f radiance = light.surface.shown(e);
    const Vec3f shown = factor * radiance;
    colours.push_back({srgb_code(shown.x), srgb_code(shown.y), srgb_code(shown.z)});
    const float most = std::max({radiance.x, radiance.y, radiance.z});
    if (factor * most > kWhite) ++too_bright;
    brightest = std::max(brightest, most);
  }
  if (too_bright > 0) {
    const double enough = std::floor(-10.0 * std::log2(double(brightest))) / 10.0;
    session.warn(fmt::format("{} of {} vertices are brighter than white: --exposure {:g} would show them", too_bright,
                             light.e.size(), enough));
  }
  return colours;
}

std::vector<float> light_values(const VertexLight& light) {
  std::vector<float> values;
  values.reserve(light.e.size() * std::size_t(light.channels));
  for (const Vec3f& e : light.e)
    for (int c = 0; c < light.channels; ++c) values.push_back(e[c]);
  return values;
}

}  // namespace isolux
