#include <isolux/mc_extract/iso_extractor.h>

#include <optional>
#include <utility>

#include "build_mesh.h"
#include "cap_box.h"
#include "openmesh_memory.h"
#include "row_march.h"

namespace isolux {

class IsoExtractor::Implementation {
 public:
  Implementation(const Volume& volume, const Run& run, Index index) : volume_(&volume), march_(volume) {
    if (index == Index::kBricks) index_.emplace(volume, run);
  }

  void extract(const ExtractSettings& settings, const Run& run, IndexedMesh& mesh) {
    const mc::MeshSize size = count(settings, run, mc::Connectivity::kIndexed);
    resize(mesh.positions, size.vertices);
    resize(mesh.normals, size.vertices);
    resize(mesh.triangles, size.triangles);
    if (size.triangles > 0) {
      march_.write_vertices(run, &mesh.positions[0].x, &mesh.normals[0].x);
      march_.write_triangles(run, mesh.triangles.data());
    }
    mc::finish_mesh(mesh, *volume_, settings);
  }

  void extract(const ExtractSettings& settings, const Run& run, IsoMesh& mesh) {
    if (settings.cap != CapKind::kNone || settings.min_component > 0) {
      IndexedMesh indexed;
      extract(settings, run, indexed);
      mesh = mc::build_mesh(indexed);
      return;
    }
    const mc::MeshSize size = count(settings, run, mc::Connectivity::kHalfEdges);
    const mc::MeshMemory memory = mc::resize_mesh(mesh, size.vertices, size.edges, size.triangles);
    if (size.triangles == 0) return;
    march_.write_vertices(run, memory.positions, memory.normals);
    march_.write_half_edges(run, memory.connectivity);
    if (settings.normals == NormalKind::kFaces) mc::set_face_normals(mesh);
  }

 private:
  mc::MeshSize count(const ExtractSettings& settings, const Run& run, mc::Connectivity connectivity) {
    return march_.count(settings, run, index_ ? &*index_ : nullptr, connectivity);
  }

  template <class T>
  static void resize(LargeVector<T>& vector, std::size_t size) {
    if (vector.capacity() < size) LargeVector<T>().swap(vector);  // nothing of the old is to be copied
    vector.resize(size);
  }

  const Volume* volume_;
  mc::RowMarch march_;
  std::optional<mc::BrickIndex> index_;
};

IsoExtractor::IsoExtractor(const Volume& volume, const Run& run, Index index)
    : implementation_(std::make_unique<Implementation>(volume, run, index)) {}
IsoExtractor::~IsoExtractor() = default;
IsoExtractor::IsoExtractor(IsoExtractor&& other) noexcept = default;
IsoExtractor& IsoExtractor::operator=(IsoExtractor&& other) noexcept = default;

void IsoExtractor::extract(const ExtractSettings& settings, const Run& run, IndexedMesh& mesh) {
  implementation_->extract(settings, run, mesh);
}

void IsoExtractor::extract(const ExtractSettings& settings, const Run& run, IsoMesh& mesh) {
  implementation_->extract(settings, run, mesh);
}

}  // namespace isolux
