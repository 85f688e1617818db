#include "openmesh_memory.h"

#include <algorithm>
#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace isolux::mc {

namespace {

static_assert(sizeof(IsoMesh::Halfedge) == sizeof(HalfEdgeRecord));
static_assert(sizeof(IsoMesh::Edge) == 2 * sizeof(HalfEdgeRecord));
static_assert(sizeof(IsoMesh::Vertex) == sizeof(std::int32_t) && sizeof(IsoMesh::Face) == sizeof(std::int32_t));
static_assert(sizeof(IsoMesh::Point) == 3 * sizeof(float) && sizeof(IsoMesh::Normal) == 3 * sizeof(float));

/// Asks for huge pages for memory that is reserved but not yet touched.
void advise_huge_pages(void* memory, std::size_t bytes) {
#ifdef __linux__
  constexpr std::uintptr_t kHugePage = std::uintptr_t(2) << 20;
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + kHugePage - 1) / kHugePage * kHugePage;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / kHugePage * kHugePage;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // NOLINT: an address
#else
  (void)memory;
  (void)bytes;
#endif
}

MeshMemory memory_of(IsoMesh& mesh) {
  MeshMemory memory;
  const OpenMesh::VertexHandle v(0);
  memory.connectivity.half_edges = reinterpret_cast<HalfEdgeRecord*>(&mesh.halfedge(OpenMesh::HalfedgeHandle(0)));
  memory.connectivity.vertex_half_edge = reinterpret_cast<std::int32_t*>(&mesh.vertex(v));
  memory.connectivity.face_half_edge = reinterpret_cast<std::int32_t*>(&mesh.face(OpenMesh::FaceHandle(0)));
  memory.positions = &mesh.point(v)[0];
  memory.normals = &mesh.property(mesh.vertex_normals_pph(), v)[0];
  return memory;
}

}  // namespace

MeshMemory reserve_mesh(IsoMesh& mesh, const MeshSize& size) {
  if (size.triangles == 0) {
    mesh.resize(0, 0, 0);
    return {};
  }
  const bool fresh = mesh.n_vertices() == 0;
  mesh.reserve(size.vertices, size.edges, size.triangles);
  // At least one item shows where the memory lies, before anything but its first page is touched.
  mesh.resize(std::clamp(mesh.n_vertices(), std::size_t(1), size.vertices),
              std::clamp(mesh.n_edges(), std::size_t(1), size.edges),
              std::clamp(mesh.n_faces(), std::size_t(1), size.triangles));
  const MeshMemory reserved = memory_of(mesh);
  if (fresh) {
    advise_huge_pages(reserved.connectivity.half_edges, size.edges * sizeof(IsoMesh::Edge));
    advise_huge_pages(reserved.connectivity.vertex_half_edge, size.vertices * sizeof(IsoMesh::Vertex));
    advise_huge_pages(reserved.connectivity.face_half_edge, size.triangles * sizeof(IsoMesh::Face));
    advise_huge_pages(reserved.positions, size.vertices * sizeof(IsoMesh::Point));
    advise_huge_pages(reserved.normals, size.vertices * sizeof(IsoMesh::Normal));
  }
  return reserved;
}

void reach(IsoMesh& mesh, const MeshSize& size) {
  mesh.resize(std::max(mesh.n_vertices(), size.vertices), std::max(mesh.n_edges(), size.edges),
              std::max(mesh.n_faces(), size.triangles));
}

}  // namespace isolux::mc
