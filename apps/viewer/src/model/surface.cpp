#include "model/surface.h"

#include <isolux/core/error.h>
#include <isolux/core/stopwatch.h>

#include <new>

namespace isolux::viewer {
namespace {

IndexedMesh indexed(const IsoMesh& mesh) {
  IndexedMesh result;
  result.positions.reserve(mesh.n_vertices());
  result.normals.reserve(mesh.n_vertices());
  result.triangles.reserve(mesh.n_faces());
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    const auto& n = mesh.normal(v);
    result.positions.emplace_back(p[0], p[1], p[2]);
    result.normals.emplace_back(n[0], n[1], n[2]);
  }
  for (const auto f : mesh.faces()) {
    Triangle triangle{};
    std::size_t corner = 0;
    for (const auto v : mesh.fv_range(f)) triangle[corner++] = std::uint32_t(v.idx());
    result.triangles.push_back(triangle);
  }
  return result;
}

}  // namespace

Surface extract_surface(const Extractor& extractor, const Volume& volume, const ExtractSettings& settings,
                        const Run& run) {
  Surface surface;
  surface.settings = settings;
  const Stopwatch watch;
  try {
    surface.mesh = indexed(extractor.extract(volume, settings, run));
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    surface.error = error.what();
  } catch (const std::bad_alloc&) {
    surface.error = "not enough memory for this surface";
  }
  surface.seconds = watch.seconds();
  return surface;
}

}  // namespace isolux::viewer
