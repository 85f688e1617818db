#include "model/document.h"

#include <isolux/bake/light_metadata.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract/write_mesh.h>
#include <isolux/render/image.h>
#include <isolux/resample/light_reader.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isolux::viewer {
namespace {

Vec3f position(const IsoMesh& mesh, std::size_t vertex) {
  const auto& p = mesh.point(IsoMesh::VertexHandle(int(vertex)));
  return {p[0], p[1], p[2]};
}

/// e at the vertices, read from the light.
std::vector<Vec3f> read_at_vertices(const Document& document, const IsoMesh& mesh, const ExtractSettings& settings,
                                    const Run& run) {
  const IlluminationGrid& grid = shown_grid(*document.light->file, settings.outer);
  const LightReader reader(document.volume->floats(), grid, TexelStorage::kDense, run);
  const IndexToWorld& frame = document.volume->lattice().frame;
  std::vector<Vec3f> radiance;
  radiance.reserve(mesh.n_vertices());
  for (std::size_t v = 0; v < mesh.n_vertices(); ++v)
    radiance.push_back(reader.at_index(frame.index(Vec3(position(mesh, v))), double(settings.isovalue)));
  return radiance;
}

void require_same_vertices(const IsoMesh& mesh, std::span<const Vec3f> positions) {
  bool same = mesh.n_vertices() == positions.size();
  for (std::size_t v = 0; same && v < positions.size(); ++v) same = position(mesh, v) == positions[v];
  if (!same) throw InvalidInput("the exact light is of another mesh of this surface: not saved");
}

}  // namespace

KnownLight known_light(std::shared_ptr<const LightFile> file) {
  std::optional<Scene> scene = light_scene(*file);
  return {std::move(file), std::move(scene)};
}

Document make_document(StoredVolume volume) {
  Document document;
  document.volume = std::make_shared<const ViewedVolume>(std::move(volume));
  document.histogram = make_histogram(document.volume->stored());
  return document;
}

OuterSide outer_side(const Document& document, const Scene& scene, std::optional<OuterSide> wanted) {
  if (wanted) return *wanted;
  return document.light ? light_outer(*document.light->file) : scene.outer;
}

const IlluminationGrid* grid_of(const LightFile& light, OuterSide side) {
  if (side_towards(light, side) == LevelSetSide::kOuter) return &light.grid;
  return light.inner ? &*light.inner : nullptr;
}

const IlluminationGrid& shown_grid(const LightFile& light, OuterSide outer) {
  return light_of_side(light, side_towards(light, outer), "the light");
}

bool has_light_of(const Document& document, float isovalue) {
  return document.light && document.light->file->grid.detail.covers(double(isovalue));
}

SurfaceColour surface_colour_of(const Document& document, const Scene& scene, float isovalue) {
  if (!document.light) return surface_colour(scene, isovalue);
  const KnownLight& light = *document.light;
  return light.scene ? surface_colour(*light.scene, isovalue) : surface_colour(*light.file, isovalue);
}

Index3 draft_texels(Index3 volume_size, const DraftLimits& limits) {
  const Vec3 cells(volume_size - 1);
  const double factor = std::min(1.0, std::cbrt(limits.texels / (cells.x * cells.y * cells.z)));
  return glm::clamp(Index3(cells * factor), Index3(1), Index3(limits.texels_an_axis));
}

LightFile bake_draft(const Volume& volume, const Scene& scene, const DraftLimits& limits, const Stages& stages,
                     const Run& run) {
  BakeSettings settings;
  settings.trace.rays = 16;
  const Index3 size = volume.lattice().size;
  settings.texels = draft_texels(size, limits);
  // Its near field is shown from the volume itself, in a texture of its own.
  if (std::max({size.x, size.y, size.z}) > limits.texels_an_axis)
    settings.resampler = {.name = "direct", .settings = {{"near_field", "false"}}};
  return make_light_file(bake(volume, scene, settings, stages, run), volume, scene, run);
}

PointLight trace_surface(const Document& document, const Lighted& lighted, float isovalue,
                         std::span<const Vec3f> positions, const Stages& stages, const Run& run) {
  const Volume& volume = document.volume->floats();
  TraceSettings settings;
  Scene scene = lighted.scene;
  const IlluminationGrid* grid = nullptr;
  if (document.light) {
    const KnownLight& light = *document.light;
    if (!light.scene) throw InvalidInput("the light does not tell its whole scene: exact light would differ from it");
    scene = *light.scene;
    settings.bounces = light_bounces(*light.file);
    if (has_light_of(document, isovalue)) grid = grid_of(*light.file, lighted.outer);
  }
  scene.outer = lighted.outer;
  if (grid == nullptr) return light_points(volume, scene, positions, settings, {}, stages, run);
  const LightReader reader(volume, *grid, TexelStorage::kDense, run);
  return light_points(volume, scene, positions, settings, {}, stages, run, reader);
}

void export_surface(const Document& document, const Scene& scene, const VertexLight& light, const Stages& stages,
                    const BackendChoice& extractor, const ExtractSettings& settings, const Run& run,
                    const std::string& path) {
  const IsoMesh mesh =
      stages.extractors.create(extractor.name, extractor.settings)->extract(document.volume->stored(), settings, run);
  std::vector<Vec3f> radiance;
  if (light.source == VertexLight::Source::kBaked) radiance = read_at_vertices(document, mesh, settings, run);
  if (light.source == VertexLight::Source::kExact) {
    require_same_vertices(mesh, light.positions);
    radiance.assign(light.radiance.begin(), light.radiance.end());
  }
  const SurfaceColour surface = surface_colour_of(document, scene, settings.isovalue);
  std::vector<Rgb8> colours;
  colours.reserve(radiance.size());
  for (const Vec3f& e : radiance) {
    const Vec3f shown = surface.shown(e);
    colours.push_back({srgb_code(shown.x), srgb_code(shown.y), srgb_code(shown.z)});
  }
  write_ply(mesh, colours, path);
}

}  // namespace isolux::viewer
