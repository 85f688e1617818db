#include "build_mesh.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract/extractor.h>

#include <glm/geometric.hpp>
#include <limits>

namespace isolux::mc {

namespace {

using Index = std::uint32_t;
constexpr Index kNone = std::numeric_limits<Index>::max();

/// Corner c = 3 t + i of triangle t stands for the half-edge from its i-th vertex to the next.
struct Corners {
  const LargeVector<Triangle>& triangles;
  [[nodiscard]] Index count() const { return Index(3 * triangles.size()); }
  [[nodiscard]] Index from(Index c) const { return triangles[c / 3][c % 3]; }
  [[nodiscard]] Index to(Index c) const { return triangles[c / 3][(c + 1) % 3]; }
  [[nodiscard]] static Index next(Index c) { return c % 3 == 2 ? c - 2 : c + 1; }
  [[nodiscard]] static Index prev(Index c) { return c % 3 == 0 ? c + 2 : c - 1; }
};

/// The corners leaving each vertex: `corner[first[v]] .. corner[first[v + 1]]`.
struct Leaving {
  std::vector<Index> first;
  std::vector<Index> corner;

  Leaving(const Corners& corners, std::size_t vertices) : first(vertices + 1, 0), corner(corners.count()) {
    for (Index c = 0; c < corners.count(); ++c) ++first[corners.from(c) + 1];
    for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
    std::vector<Index> place(first.begin(), first.end() - 1);
    for (Index c = 0; c < corners.count(); ++c) corner[place[corners.from(c)]++] = c;
  }
};

/// Half-edge of each corner: 2 e and 2 e + 1 for the two sides of edge e.
std::vector<Index> number_half_edges(const Corners& corners, const Leaving& leaving, Index& edges) {
  std::vector<Index> half_edge(corners.count(), kNone);
  edges = 0;
  for (Index c = 0; c < corners.count(); ++c) {
    const Index u = corners.from(c);
    const Index v = corners.to(c);
    for (Index i = leaving.first[u]; i < leaving.first[u + 1]; ++i) {
      const Index twin = leaving.corner[i];
      if (twin != c && corners.to(twin) == v)
        throw InvalidInput(
            fmt::format("the edge from vertex {} to vertex {} belongs to two triangles in the same "
                        "direction: a half-edge mesh must be manifold and oriented",
                        u, v));
    }
    if (half_edge[c] != kNone) continue;
    half_edge[c] = 2 * edges;
    for (Index i = leaving.first[v]; i < leaving.first[v + 1]; ++i)
      if (corners.to(leaving.corner[i]) == u) half_edge[leaving.corner[i]] = 2 * edges + 1;
    ++edges;
  }
  return half_edge;
}

using HalfedgeHandle = OpenMesh::HalfedgeHandle;
using VertexHandle = OpenMesh::VertexHandle;
using FaceHandle = OpenMesh::FaceHandle;

/// Half-edges without a face: each vertex on the border has one that leaves it, which its successor is found by.
void link_border(IsoMesh& mesh) {
  const auto count = int(mesh.n_halfedges());
  for (int h = 0; h < count; ++h) {
    const HalfedgeHandle border(h);
    if (mesh.face_handle(border).is_valid()) continue;
    const HalfedgeHandle inner(h ^ 1);
    mesh.set_vertex_handle(border, mesh.to_vertex_handle(mesh.prev_halfedge_handle(inner)));
    mesh.set_halfedge_handle(mesh.to_vertex_handle(inner), border);
  }
  for (int h = 0; h < count; ++h) {
    const HalfedgeHandle border(h);
    if (mesh.face_handle(border).is_valid()) continue;
    mesh.set_next_halfedge_handle(border, mesh.halfedge_handle(mesh.to_vertex_handle(border)));
  }
}

}  // namespace

IsoMesh build_mesh(const IndexedMesh& indexed) {
  IsoMesh mesh;
  build_mesh(indexed, mesh);
  return mesh;
}

void build_mesh(const IndexedMesh& indexed, IsoMesh& mesh) {
  const std::size_t vertices = indexed.positions.size();
  const std::size_t faces = indexed.triangles.size();
  if (6 * faces > std::size_t(std::numeric_limits<int>::max()))
    throw InvalidInput(fmt::format("a mesh of {} triangles: OpenMesh numbers at most 2^31 half-edges", faces));
  const Corners corners{indexed.triangles};
  Index edges = 0;
  const std::vector<Index> half_edge = number_half_edges(corners, Leaving(corners, vertices), edges);
  mesh.clear();
  mesh.resize(vertices, edges, faces);
  for (std::size_t v = 0; v < vertices; ++v) {
    const VertexHandle handle{int(v)};
    const Vec3f& p = indexed.positions[v];
    const Vec3f& n = indexed.normals[v];
    mesh.set_point(handle, {p.x, p.y, p.z});
    mesh.set_normal(handle, {n.x, n.y, n.z});
  }
  for (Index c = 0; c < corners.count(); ++c) {
    const HalfedgeHandle h{int(half_edge[c])};
    mesh.set_face_handle(h, FaceHandle(int(c / 3)));
    mesh.set_vertex_handle(h, VertexHandle(int(corners.to(c))));
    mesh.set_next_halfedge_handle(h, HalfedgeHandle(int(half_edge[Corners::next(c)])));
    mesh.set_halfedge_handle(VertexHandle(int(corners.from(c))), h);
    if (c % 3 == 0) mesh.set_halfedge_handle(FaceHandle(int(c / 3)), h);
  }
  link_border(mesh);
}

namespace {

/// Adds each face's area vector to its vertices and lets `assign(vertex, unit normal)` have the sums' directions.
template <class Position, class Assign>
void sum_face_normals(std::size_t vertices, std::size_t faces, const auto& corners, const Position& position,
                      const Assign& assign) {
  std::vector<Vec3> sums(vertices, Vec3(0.0));
  for (std::size_t f = 0; f < faces; ++f) {
    const Triangle t = corners(f);
    const Vec3 a = position(t[0]);
    const Vec3 area = glm::cross(position(t[1]) - a, position(t[2]) - a);
    for (const Index v : t) sums[v] += area;
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    const double length = glm::length(sums[v]);
    if (length > 0.0 && length < std::numeric_limits<double>::infinity()) assign(Index(v), Vec3f(sums[v] / length));
  }
}

Triangle face_corners(const IsoMesh& mesh, std::size_t face) {
  const HalfedgeHandle first = mesh.halfedge_handle(FaceHandle(int(face)));
  const HalfedgeHandle second = mesh.next_halfedge_handle(first);
  return {Index(mesh.from_vertex_handle(first).idx()), Index(mesh.to_vertex_handle(first).idx()),
          Index(mesh.to_vertex_handle(second).idx())};
}

}  // namespace

void set_face_normals(IndexedMesh& mesh) {
  sum_face_normals(
      mesh.positions.size(), mesh.triangles.size(), [&](std::size_t f) { return mesh.triangles[f]; },
      [&](Index v) { return Vec3(mesh.positions[v]); }, [&](Index v, const Vec3f& n) { mesh.normals[v] = n; });
}

void set_face_normals(IsoMesh& mesh) {
  sum_face_normals(
      mesh.n_vertices(), mesh.n_faces(), [&](std::size_t f) { return face_corners(mesh, f); },
      [&](Index v) {
        const auto& p = mesh.point(VertexHandle(int(v)));
        return Vec3(p[0], p[1], p[2]);
      },
      [&](Index v, const Vec3f& n) {
        mesh.set_normal(VertexHandle(int(v)), {n.x, n.y, n.z});
      });
}

}  // namespace isolux::mc

namespace isolux {

IndexedMesh indexed_mesh(const IsoMesh& mesh) {
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
  for (std::size_t f = 0; f < mesh.n_faces(); ++f) result.triangles.push_back(mc::face_corners(mesh, f));
  return result;
}

}  // namespace isolux
