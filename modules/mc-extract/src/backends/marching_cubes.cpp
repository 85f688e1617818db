#include <isolux/mc_extract/extractor.h>

#include <array>
#include <vector>

#include "build_mesh.h"
#include "cell_polygons.h"
#include "cube.h"
#include "surface_builder.h"

namespace isolux {

namespace {

/// Triangles of each of the 256 cases, inside corners kept apart on ambiguous faces.
std::array<std::vector<mc::EdgeTriangle>, 256> make_cases() {
  std::array<std::vector<mc::EdgeTriangle>, 256> cases;
  for (int inside = 0; inside < 256; ++inside)
    for (const mc::CellPolygon& polygon : mc::cell_polygons(inside, 0))
      for (const mc::EdgeTriangle& triangle : mc::triangulate(polygon)) cases[inside].push_back(triangle);
  return cases;
}

/// Marching cubes (Lorensen & Cline 1987) with a table made by rule: see cell_polygons.h.
class MarchingCubes final : public Extractor {
 public:
  using Options = NoOptions;
  explicit MarchingCubes(const Options& /*options*/) : cases_(make_cases()) {}

  [[nodiscard]] IsoMesh extract(const Volume& volume, const ExtractSettings& settings, const Run& run) const override {
    mc::SurfaceBuilder surface(volume, settings);
    const Index3 cells = volume.lattice().size - 1;
    for (int k = 0; k < cells.z; ++k) {
      throw_if_stopped(run);
      surface.begin_slab(k);
      for (int j = 0; j < cells.y; ++j)
        for (int i = 0; i < cells.x; ++i) add_cell(surface, {i, j, k});
    }
    return mc::build_mesh(surface.take());
  }

 private:
  void add_cell(mc::SurfaceBuilder& surface, const Index3& cell) const {
    for (const mc::EdgeTriangle& triangle : cases_[surface.inside_corners(cell)]) {
      std::array<std::uint32_t, 3> ids{};
      for (int v = 0; v < 3; ++v) {
        const mc::CubeEdge& edge = mc::kCubeEdges[triangle[v]];
        const Index3 low = cell + Index3(edge.low & 1, edge.low >> 1 & 1, edge.low >> 2);
        ids[v] = surface.edge_vertex(low, 1 << edge.axis);
      }
      surface.add_triangle(ids[0], ids[1], ids[2]);
    }
  }

  std::array<std::vector<mc::EdgeTriangle>, 256> cases_;
};

}  // namespace

namespace backends {
void marching_cubes(Registry<Extractor>& registry) {
  registry.add<MarchingCubes>("marching_cubes", "marching cubes, consistent on ambiguous faces: always a manifold");
}
}  // namespace backends

}  // namespace isolux
