#include <isolux/core/parallel.h>
#include <isolux/mc_extract/accurate_normals.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <variant>

#include "high_order_gradient.h"
#include "level_set.h"

namespace isolux {

namespace {

/// `position(v)` is asked for, `assign(v, normal)` gets what replaces the vertex's normal.
void set_normals(const VolumeView& volume, OuterSide outer, const Run& run, std::size_t vertices, const auto& position,
                 const auto& assign) {
  const IndexToWorld& frame = volume.lattice().frame;
  const Mat3 to_index = glm::inverse(frame.axes);
  const Mat3 to_normal = frame.gradient_to_world() * (outer == OuterSide::kLower ? -1.0 : 1.0);
  // Vertices keep a margin from grid points, so half of it tells which coordinates lie on the grid.
  const Vec3 tolerance = 0.5 * Vec3(vertex_margin(volume.lattice()));
  const auto set_by = [&](const auto& gradient) {
    constexpr std::size_t kBlock = 4096;
    parallel_blocks(vertices, kBlock, run, "normals", [&](const Block& block) {
      for (std::size_t v = block.begin; v < block.end; ++v) {
        const Vec3 index = to_index * (position(v) - frame.origin);
        if (gradient.is_grid_point(index)) continue;
        const auto g = gradient.at(index);
        if (!g) continue;
        const Vec3 normal = to_normal * *g;
        const double length = glm::length(normal);
        if (length > 0.0 && std::isfinite(length)) assign(v, Vec3f(normal / length));
      }
    });
  };
  std::visit(
      [&]<class Value>(std::span<const Value> values) {
        set_by(mc::HighOrderGradient(TrilinearFieldOf<Value>(volume.lattice(), values), tolerance));
      },
      volume.voxels());
}

}  // namespace

void set_accurate_normals(const VolumeView& volume, OuterSide outer, const Run& run, IndexedMesh& mesh) {
  set_normals(
      volume, outer, run, mesh.positions.size(), [&](std::size_t v) { return Vec3(mesh.positions[v]); },
      [&](std::size_t v, const Vec3f& n) { mesh.normals[v] = n; });
}

void set_accurate_normals(const VolumeView& volume, OuterSide outer, const Run& run, IsoMesh& mesh) {
  set_normals(
      volume, outer, run, mesh.n_vertices(),
      [&](std::size_t v) {
        const auto& p = mesh.point(OpenMesh::VertexHandle(int(v)));
        return Vec3(p[0], p[1], p[2]);
      },
      [&](std::size_t v, const Vec3f& n) {
        mesh.set_normal(OpenMesh::VertexHandle(int(v)), {n.x, n.y, n.z});
      });
}

}  // namespace isolux
