// What every extracted mesh must satisfy.
#pragma once

#include <gtest/gtest.h>
#include <isolux/core/volume.h>
#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/mc_extract/iso_mesh.h>

#include <OpenMesh/Tools/Utils/MeshCheckerT.hh>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <sstream>
#include <vector>

namespace isolux::testing {

inline Vec3 point(const IsoMesh& mesh, OpenMesh::VertexHandle v) {
  const auto& p = mesh.point(v);
  return {p[0], p[1], p[2]};
}

inline Vec3 normal(const IsoMesh& mesh, OpenMesh::VertexHandle v) {
  const auto& n = mesh.normal(v);
  return {n[0], n[1], n[2]};
}

inline std::array<OpenMesh::VertexHandle, 3> corners(const IsoMesh& mesh, OpenMesh::FaceHandle f) {
  const auto h = mesh.halfedge_handle(f);
  return {mesh.from_vertex_handle(h), mesh.to_vertex_handle(h), mesh.to_vertex_handle(mesh.next_halfedge_handle(h))};
}

/// Twice the area, along the normal.
inline Vec3 area_vector(const IsoMesh& mesh, OpenMesh::FaceHandle f) {
  const auto [a, b, c] = corners(mesh, f);
  return glm::cross(point(mesh, b) - point(mesh, a), point(mesh, c) - point(mesh, a));
}

inline int euler_number(const IsoMesh& mesh) {
  return int(mesh.n_vertices()) - int(mesh.n_edges()) + int(mesh.n_faces());
}

inline double area(const IsoMesh& mesh) {
  double sum = 0.0;
  for (const auto f : mesh.faces()) sum += 0.5 * glm::length(area_vector(mesh, f));
  return sum;
}

inline double enclosed_volume(const IsoMesh& mesh) {
  double sum = 0.0;
  for (const auto f : mesh.faces()) sum += glm::dot(area_vector(mesh, f), point(mesh, corners(mesh, f)[0])) / 6.0;
  return sum;
}

inline int boundary_edges(const IsoMesh& mesh) {
  int count = 0;
  for (const auto e : mesh.edges()) count += mesh.is_boundary(e) ? 1 : 0;
  return count;
}

inline int zero_area_triangles(const IsoMesh& mesh) {
  int count = 0;
  for (const auto f : mesh.faces()) count += glm::length(area_vector(mesh, f)) > 0.0 ? 0 : 1;
  return count;
}

/// OpenMesh's own checker; and each vertex has one fan: going round it meets every face that names it.
inline ::testing::AssertionResult is_manifold(IsoMesh& mesh) {
  std::ostringstream complaints;
  OpenMesh::Utils::MeshCheckerT<IsoMesh> checker(mesh);
  if (!checker.check(OpenMesh::Utils::MeshCheckerT<IsoMesh>::CHECK_ALL, complaints))
    return ::testing::AssertionFailure() << complaints.str().substr(0, 500);
  std::vector<int> named(mesh.n_vertices(), 0);
  for (const auto f : mesh.faces())
    for (const auto v : corners(mesh, f)) ++named[std::size_t(v.idx())];
  for (const auto v : mesh.vertices()) {
    int met = 0;
    for ([[maybe_unused]] const auto f : mesh.vf_range(v)) ++met;
    if (met != named[std::size_t(v.idx())] || met == 0)
      return ::testing::AssertionFailure()
             << "vertex " << v.idx() << ": " << met << " of " << named[std::size_t(v.idx())] << " faces in its fan";
  }
  return ::testing::AssertionSuccess();
}

/// add_face, face by face, takes the mesh too: no complex edge, no complex vertex.
inline ::testing::AssertionResult openmesh_accepts(const IsoMesh& mesh) {
  IsoMesh copy;
  for (const auto v : mesh.vertices()) copy.add_vertex(mesh.point(v));
  for (const auto f : mesh.faces()) {
    const auto [a, b, c] = corners(mesh, f);
    if (!copy.add_face(a, b, c).is_valid())
      return ::testing::AssertionFailure() << "face " << f.idx() << " is refused by add_face";
  }
  return ::testing::AssertionSuccess();
}

/// Boundary edges lie in a face of the box.
inline ::testing::AssertionResult is_open_only_at_the_box(const IsoMesh& mesh, const Lattice& lattice) {
  for (const auto e : mesh.edges()) {
    if (!mesh.is_boundary(e)) continue;
    const auto h = mesh.halfedge_handle(e, 0);
    const Vec3 a = lattice.frame.index(point(mesh, mesh.from_vertex_handle(h)));
    const Vec3 b = lattice.frame.index(point(mesh, mesh.to_vertex_handle(h)));
    bool on_face = false;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {0.0, lattice.size[axis] - 1.0})
        on_face |= std::fabs(a[axis] - side) < 1e-4 && std::fabs(b[axis] - side) < 1e-4;  // float coordinates
    if (!on_face) return ::testing::AssertionFailure() << "edge " << e.idx() << " is open inside the box";
  }
  return ::testing::AssertionSuccess();
}

inline ::testing::AssertionResult normals_are_unit(const IsoMesh& mesh) {
  for (const auto v : mesh.vertices())
    if (!(std::fabs(glm::length(normal(mesh, v)) - 1.0) < 1e-5))  // a few roundings of a float
      return ::testing::AssertionFailure()
             << "normal of vertex " << v.idx() << " has length " << glm::length(normal(mesh, v));
  return ::testing::AssertionSuccess();
}

inline bool identical(const IndexedMesh& a, const IndexedMesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.triangles == b.triangles;
}

/// Same half-edges, same bits of points and normals.
inline bool identical(const IsoMesh& a, const IsoMesh& b) {
  if (a.n_vertices() != b.n_vertices() || a.n_halfedges() != b.n_halfedges() || a.n_faces() != b.n_faces())
    return false;
  for (const auto v : a.vertices())
    if (a.point(v) != b.point(v) || a.normal(v) != b.normal(v) || a.halfedge_handle(v) != b.halfedge_handle(v))
      return false;
  for (const auto h : a.halfedges())
    if (a.to_vertex_handle(h) != b.to_vertex_handle(h) || a.next_halfedge_handle(h) != b.next_halfedge_handle(h) ||
        a.prev_halfedge_handle(h) != b.prev_halfedge_handle(h) || a.face_handle(h) != b.face_handle(h))
      return false;
  for (const auto f : a.faces())
    if (a.halfedge_handle(f) != b.halfedge_handle(f)) return false;
  return true;
}

}  // namespace isolux::testing
