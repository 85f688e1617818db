// Marching cubes cell by cell, with nothing clever: what the fast one must agree with.
#pragma once

#include <isolux/mc_extract/extractor.h>

#include <array>
#include <vector>

#include "cell_polygons.h"
#include "cube.h"
#include "surface_builder.h"

namespace isolux::testing {

inline IndexedMesh plain_marching_cubes(const Volume& volume, const ExtractSettings& settings) {
  const auto add_cell = [](mc::SurfaceBuilder& surface, const Index3& cell, int inside) {
    for (const mc::CellPolygon& polygon : mc::cell_polygons(inside, 0)) {
      for (const mc::EdgeTriangle& triangle : mc::triangulate(polygon)) {
        std::array<std::uint32_t, 3> ids{};
        for (int v = 0; v < 3; ++v) {
          const mc::CubeEdge& edge = mc::kCubeEdges[triangle[v]];
          ids[v] = surface.edge_vertex(cell + Index3(edge.low & 1, edge.low >> 1 & 1, edge.low >> 2), 1 << edge.axis);
        }
        surface.add_triangle(ids[0], ids[1], ids[2]);
      }
    }
  };
  return mc::build_surface(volume, settings, {.threads = 1}, add_cell);
}

}  // namespace isolux::testing
