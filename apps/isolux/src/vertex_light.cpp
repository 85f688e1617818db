#include "vertex_light.h"

#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/bake/light_on_box.h>
#include <isolux/mc_extract/cap_vertices.h>
#include <isolux/render/image.h>

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

}  // namespace

const LightReader& VertexLighter::reader() {
  if (!reader_) {
    const IlluminationGrid& grid = options_.light.of_side(*baked_, side_towards(*baked_, scene_.outer));
    reader_.emplace(volume_, grid, TexelStorage::kBricks, session_.run);
  }
  return *reader_;
}

/// Light traced at points, with a baked one as control variate if there is one of their level set.
PointLight VertexLighter::exact_light(const std::vector<Vec3f>& positions, float isovalue) {
  const BackendChoice tracer{options_.trace.tracer(), {}};
  TraceSettings settings = options_.trace.settings();
  if (baked_ && !options_.trace.bounces_given()) settings.bounces = light_bounces(*baked_);
  if (!baked_ || !baked_->grid.detail.covers(double(isovalue)))
    return light_points(volume_, scene_, positions, settings, tracer, session_.stages, session_.run);
  return light_points(volume_, scene_, positions, settings, tracer, session_.stages, session_.run, reader());
}

std::vector<Vec3f> VertexLighter::baked_light(const std::vector<Vec3f>& positions, float isovalue) {
  const LightReader& light = reader();
  std::vector<Vec3f> radiance;
  radiance.reserve(positions.size());
  for (const Vec3f& p : positions)
    radiance.push_back(light.at_index(volume_.lattice().frame.index(Vec3(p)), double(isovalue)));
  return radiance;
}

/// Whose light a cap is in: the scene that is traced, or that of the baked light.
const Scene& VertexLighter::scene_of_cap() {
  if (options_.exact_light) return scene_;
  if (scene_of_cap_) return *scene_of_cap_;
  return scene_of_cap_.emplace(isolux::scene_of_cap(*baked_, options_.trace, session_));
}

PointLight VertexLighter::cap_light(const std::vector<std::uint32_t>& vertices, const std::vector<Vec3f>& positions,
                                    const IsoMesh& mesh) {
  std::vector<Vec3f> normals;
  normals.reserve(vertices.size());
  for (const std::uint32_t v : vertices) {
    const auto& n = mesh.normal(OpenMesh::VertexHandle(int(v)));
    normals.emplace_back(n[0], n[1], n[2]);
  }
  return light_on_box(volume_.lattice(), scene_of_cap(), positions, normals, options_.trace.settings(),
                      {options_.trace.tracer(), {}}, session_.stages, session_.run);
}

VertexLight VertexLighter::light(const IsoMesh& mesh, float isovalue) {
  VertexLight result;
  result.e.assign(mesh.n_vertices(), Vec3f(0.0f));
  const SurfaceAndCap parts = parts_of(mesh, volume_.lattice(), options_.parts.cap);
  const std::vector<Vec3f>& positions = parts.surface.positions;
  std::uint64_t rays = 0;
  if (options_.exact_light) {
    const PointLight light = session_.timed("trace", [&] { return exact_light(positions, isovalue); });
    parts.surface.assign(light.radiance, result.e);
    result.surface = surface_colour(scene_, isovalue);
    result.channels = is_grey(scene_) ? 1 : 3;
    rays = light.counters.rays;
    session_.report["rmse_estimate"] = light.rmse_estimate;
  } else {
    parts.surface.assign(session_.timed("light", [&] { return baked_light(positions, isovalue); }), result.e);
    result.surface = surface_colour(*baked_, isovalue);
    result.channels = baked_->grid.channels;
  }
  if (!parts.cap.vertices.empty()) {
    const PointLight light =
        session_.timed("trace", [&] { return cap_light(parts.cap.vertices, parts.cap.positions, mesh); });
    parts.cap.assign(light.radiance, result.e);
    if (!is_grey(scene_of_cap())) result.channels = 3;
    rays += light.counters.rays;
  }
  if (rays > 0 || options_.exact_light) session_.report["rays"] = rays;
  return result;
}

std::vector<Rgb8> shown_colours(const VertexLight& light, float isovalue, double exposure, const Session& session) {
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
    session.warn(fmt::format("isovalue {}: {} of {} vertices are brighter than white: --exposure {:g} would show them",
                             isovalue, too_bright, light.e.size(), enough));
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
