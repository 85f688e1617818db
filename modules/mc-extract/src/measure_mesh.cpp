#include <isolux/core/vec.h>
#include <isolux/mc_extract/measure_mesh.h>

#include <glm/geometric.hpp>

#include "components.h"

namespace isolux {

MeshMeasures measure_mesh(const IsoMesh& mesh) {
  MeshMeasures measures;
  measures.euler_number = std::int64_t(mesh.n_vertices()) - std::int64_t(mesh.n_edges()) + std::int64_t(mesh.n_faces());
  for (int e = 0; e < int(mesh.n_edges()); ++e)
    measures.boundary_edges += mesh.is_boundary(OpenMesh::EdgeHandle(e)) ? 1 : 0;
  double volume = 0.0;
  const auto point = [&](OpenMesh::VertexHandle v) {
    const auto& p = mesh.point(v);
    return Vec3(p[0], p[1], p[2]);
  };
  // From a point of the mesh, so that a far origin costs no digits.
  const Vec3 origin = mesh.n_vertices() > 0 ? point(OpenMesh::VertexHandle(0)) : Vec3(0.0);
  mc::VertexSets sets(mesh.n_vertices());
  for (int f = 0; f < int(mesh.n_faces()); ++f) {
    const auto first = mesh.halfedge_handle(OpenMesh::FaceHandle(f));
    const auto a = mesh.from_vertex_handle(first);
    const auto b = mesh.to_vertex_handle(first);
    const auto c = mesh.to_vertex_handle(mesh.next_halfedge_handle(first));
    const Vec3 corner = point(a) - origin;
    const Vec3 twice_area = glm::cross(point(b) - point(a), point(c) - point(a));
    const double length = glm::length(twice_area);
    measures.area += 0.5 * length;
    volume += glm::dot(corner, twice_area) / 6.0;
    if (!(length > 0.0)) ++measures.zero_area_triangles;
    sets.join(std::uint32_t(a.idx()), std::uint32_t(b.idx()));
    sets.join(std::uint32_t(a.idx()), std::uint32_t(c.idx()));
  }
  // Of an open mesh the sum depends on where the origin is.
  if (measures.boundary_edges == 0) measures.volume = volume;
  for (std::uint32_t v = 0; v < mesh.n_vertices(); ++v) measures.components += sets.find(v) == v ? 1 : 0;
  return measures;
}

}  // namespace isolux
