#include "openmesh_memory.h"

#include <isolux/core/huge_pages.h>

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

std::uintptr_t round_up(std::uintptr_t address) { return (address + kHugePage - 1) / kHugePage * kHugePage; }

/// Has memory of which only a page at each end was touched, by the allocator, lie in huge pages.
void lay_in_huge_pages(void* memory, std::size_t bytes) {
  if (bytes < kHugePage) return;
  ask_for_huge_pages(memory, bytes);
#ifdef __linux__
#ifndef MADV_COLLAPSE
#define MADV_COLLAPSE 25
#endif
  // The page touched at each end keeps its whole huge page from being one, unless they are joined: some 4000 page
  // faults a mesh, and a tenth of the time. Refused by kernels before 6.1, and where an end lies at nothing mapped.
  const auto join = [](std::uintptr_t page) {
    madvise(reinterpret_cast<void*>(page), kHugePage, MADV_COLLAPSE);  // NOLINT: an address
  };
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  join(address / kHugePage * kHugePage);
  join(round_up(address + bytes) - kHugePage);
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

VertexRoom vertex_room(IsoMesh& mesh) {
  if (mesh.n_vertices() == 0) return {};
  const OpenMesh::VertexHandle v(0);
  return {.positions = &mesh.point(v)[0],
          .normals = &mesh.property(mesh.vertex_normals_pph(), v)[0],
          .vertices = mesh.n_vertices()};
}

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
    lay_in_huge_pages(reserved.connectivity.half_edges, size.edges * sizeof(IsoMesh::Edge));
    lay_in_huge_pages(reserved.connectivity.vertex_half_edge, size.vertices * sizeof(IsoMesh::Vertex));
    lay_in_huge_pages(reserved.connectivity.face_half_edge, size.triangles * sizeof(IsoMesh::Face));
    lay_in_huge_pages(reserved.positions, size.vertices * sizeof(IsoMesh::Point));
    lay_in_huge_pages(reserved.normals, size.vertices * sizeof(IsoMesh::Normal));
  }
  return reserved;
}

void bring_huge_pages(const MeshMemory& memory, const MeshSize& before, const MeshSize& after) {
  const auto bring = [](void* items, std::size_t size, std::size_t first, std::size_t last) {
    const auto begin = reinterpret_cast<std::uintptr_t>(items);
    for (std::uintptr_t page = round_up(begin + first * size); page < begin + last * size; page += kHugePage)
      *reinterpret_cast<volatile char*>(page) = 0;  // NOLINT: an address
  };
  const HalfEdgeArrays& links = memory.connectivity;
  bring(links.half_edges, sizeof(IsoMesh::Edge), before.edges, after.edges);
  bring(links.vertex_half_edge, sizeof(IsoMesh::Vertex), before.vertices, after.vertices);
  bring(links.face_half_edge, sizeof(IsoMesh::Face), before.triangles, after.triangles);
  bring(memory.positions, sizeof(IsoMesh::Point), before.vertices, after.vertices);
  bring(memory.normals, sizeof(IsoMesh::Normal), before.vertices, after.vertices);
}

void reach(IsoMesh& mesh, const MeshSize& size) {
  mesh.resize(std::max(mesh.n_vertices(), size.vertices), std::max(mesh.n_edges(), size.edges),
              std::max(mesh.n_faces(), size.triangles));
}

}  // namespace isolux::mc
