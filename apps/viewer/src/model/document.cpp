#include "model/document.h"

#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract/write_mesh.h>
#include <isolux/render/image.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/atomic_file.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace isolux::viewer {

Document make_document(StoredVolume volume) {
  Document document;
  document.volume = std::make_shared<const ViewedVolume>(std::move(volume));
  document.histogram = make_histogram(document.volume->stored());
  return document;
}

SurfaceColour surface_colour_of(const Document& document, float isovalue) {
  return document.light ? surface_colour(*document.light, isovalue) : surface_colour(Scene{}, isovalue);
}

Index3 draft_texels(Index3 volume_size, double most) {
  const Vec3 cells(volume_size - 1);
  const double factor = std::min(1.0, std::cbrt(most / (cells.x * cells.y * cells.z)));
  return glm::max(Index3(cells * factor), Index3(1));
}

LightFile bake_draft(const Volume& volume, const Scene& scene, const Stages& stages, const Run& run) {
  BakeSettings settings;
  settings.trace.rays = 16;
  settings.texels = draft_texels(volume.lattice().size, 3e5);
  return make_light_file(bake(volume, scene, settings, stages, run), volume, scene, run);
}

PointLight trace_surface(const Document& document, const Scene& scene, std::span<const Vec3f> positions,
                         const Stages& stages, const Run& run) {
  TraceSettings settings;
  if (!document.light) return light_points(document.volume->floats(), scene, positions, settings, {}, stages, run);
  const std::optional<Scene> lights_own = light_scene(*document.light);
  if (!lights_own) throw InvalidInput("the light does not tell its whole scene: exact light would differ from it");
  settings.bounces = light_bounces(*document.light);
  const LightReader reader(document.volume->floats(), document.light->grid, TexelStorage::kDense, run);
  return light_points(document.volume->floats(), *lights_own, positions, settings, {}, stages, run, reader);
}

void export_surface(const Document& document, const Stages& stages, const BackendChoice& extractor,
                    const ExtractSettings& settings, const Run& run, const std::string& path) {
  const IsoMesh mesh =
      stages.extractors.create(extractor.name, extractor.settings)->extract(document.volume->stored(), settings, run);
  std::vector<Rgb8> colours;
  if (document.light) {
    const SurfaceColour surface = surface_colour_of(document, settings.isovalue);
    const LightReader reader(document.volume->floats(), document.light->grid, TexelStorage::kDense, run);
    const IndexToWorld& frame = document.volume->lattice().frame;
    colours.reserve(mesh.n_vertices());
    for (const auto v : mesh.vertices()) {
      const auto& p = mesh.point(v);
      const Vec3f shown = surface.shown(reader.at_index(frame.index({p[0], p[1], p[2]}), double(settings.isovalue)));
      colours.push_back({srgb_code(shown.x), srgb_code(shown.y), srgb_code(shown.z)});
    }
  }
  write_atomically_by_name(path, [&](const std::string& temporary) { write_ply(mesh, colours, temporary); });
}

std::string free_file_name(const std::string& volume_name, double isovalue, const std::string& extension) {
  std::string stem = std::filesystem::path(volume_name).stem().string();
  if (stem.empty()) stem = "volume";
  for (char& c : stem) {
    if (c == ':') c = '_';
  }
  std::string name = fmt::format("{}-{:.6g}.{}", stem, isovalue, extension);
  for (int i = 2; std::filesystem::exists(name); ++i) {
    name = fmt::format("{}-{:.6g}-{}.{}", stem, isovalue, i, extension);
  }
  return name;
}

}  // namespace isolux::viewer
