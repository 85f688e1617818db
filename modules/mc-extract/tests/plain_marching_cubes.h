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
  mc::SurfaceBuilder surface(volume, settings);
  const Index3 cells = volume.lattice().size - 1;
  for (int k = 0; k < cells.z; ++k) {
    surface.begin_slab(k);
    for (int j = 0; j < cells.y; ++j) {
      for (int i = 0; i < cells.x; ++i) {
        const Index3 cell(i, j, k);
        for (const mc::CellPolygon& polygon : mc::cell_polygons(surface.inside_corners(cell), 0)) {
          for (const mc::EdgeTriangle& triangle : mc::triangulate(polygon)) {
            std::array<std::uint32_t, 3> ids{};
            for (int v = 0; v < 3; ++v) {
              const mc::CubeEdge& edge = mc::kCubeEdges[triangle[v]];
              ids[v] =
                  surface.edge_vertex(cell + Index3(edge.low & 1, edge.low >> 1 & 1, edge.low >> 2), 1 << edge.axis);
            }
            surface.add_triangle(ids[0], ids[1], ids[2]);
          }
        }
      }
    }
  }
  return surface.take();
}

}  // namespace isolux::testing
