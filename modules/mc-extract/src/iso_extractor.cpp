#include <isolux/mc_extract/accurate_normals.h>
#include <isolux/mc_extract/iso_extractor.h>

#include <functional>
#include <optional>
#include <utility>

#include "build_mesh.h"
#include "cap_box.h"
#include "openmesh_memory.h"
#include "row_march.h"

namespace isolux {

class IsoExtractor::Implementation {
 public:
  Implementation(const VolumeView& volume, const Run& run, Index index) : volume_(volume), march_(volume) {
    if (index == Index::kBricks) index_.emplace(volume, run);
  }

  void extract(const ExtractSettings& settings, const Run& asked, IndexedMesh& mesh) {
    const Run run = suited(asked);
    march_.march(settings, run, index(), mesh);
    mc::finish_mesh(mesh, volume_, settings, run);
  }

  void extract(const ExtractSettings& settings, const Run& asked, IsoMesh& mesh) {
    const Run run = suited(asked);
    if (settings.cap != CapKind::kNone || settings.min_component > 0) {
      IndexedMesh indexed;
      extract(settings, run, indexed);
      mc::build_mesh(indexed, mesh);
      return;
    }
    const mc::MeshSize size = march_.count(settings, run, index(), mc::vertex_room(mesh));
    const mc::MeshMemory memory = mc::reserve_mesh(mesh, size);
    if (size.triangles == 0) return;
    mc::RowMarch::Fresh fresh;
    // Of each kind: a surface in many small parts has more vertices than a larger one of as many edges.
    const mc::MeshSize held{.vertices = mesh.n_vertices(), .edges = mesh.n_edges(), .triangles = mesh.n_faces()};
    if (held.vertices < size.vertices || held.edges < size.edges || held.triangles < size.triangles) {
      fresh.reach = [&](const mc::MeshSize& part) { mc::reach(mesh, part); };
      fresh.bring = [&memory, held](const mc::MeshSize& before, const mc::MeshSize& after) {
        mc::bring_huge_pages(memory, larger(before, held), after);
      };
    }
    march_.write(run, fresh, memory.positions, memory.normals, memory.connectivity);
    if (settings.normals == NormalKind::kFaces) mc::set_face_normals(mesh);
    if (settings.normals == NormalKind::kAccurate) set_accurate_normals(volume_, settings.outer, run, mesh);
  }

 private:
  static mc::MeshSize larger(const mc::MeshSize& a, const mc::MeshSize& b) {
    return {.vertices = std::max(a.vertices, b.vertices),
            .edges = std::max(a.edges, b.edges),
            .triangles = std::max(a.triangles, b.triangles)};
  }
  /// Small volumes are done before a second thread is awake.
  [[nodiscard]] Run suited(const Run& asked) const {
    constexpr std::size_t kSmall = std::size_t(1) << 15;
    Run run = asked;
    if (volume_.lattice().count() <= kSmall) run.threads = 1;
    return run;
  }
  [[nodiscard]] const mc::BrickIndex* index() const { return index_ ? &*index_ : nullptr; }

  VolumeView volume_;
  mc::RowMarch march_;
  std::optional<mc::BrickIndex> index_;
};

IsoExtractor::IsoExtractor(const VolumeView& volume, const Run& run, Index index)
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
