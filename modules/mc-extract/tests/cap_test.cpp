// What a cap adds: its vertices and their normals.
#include <gtest/gtest.h>
#include <isolux/mc_extract.h>

#include <glm/common.hpp>
#include <set>

#include "fields.h"
#include "mesh_laws.h"

namespace isolux {
namespace {

using namespace isolux::testing;

IsoMesh extract(const Volume& volume, const std::string& backend, const ExtractSettings& settings) {
  return extractors().create(backend)->extract(volume, settings, {});
}

TEST(Cap, HasTheBoxsNormalsAndLeavesTheSurfaceItsOwn) {
  for (const std::string backend : {"marching_cubes", "marching_cubes_topological", "marching_tetrahedra"}) {
    for (const NormalKind normals : {NormalKind::kGradient, NormalKind::kFaces, NormalKind::kAccurate}) {
      const Volume volume = gyroid(20);
      const IsoMesh open = extract(volume, backend, {.isovalue = 0.2f, .normals = normals});
      const IsoMesh closed = extract(volume, backend, {.isovalue = 0.2f, .normals = normals, .cap = CapKind::kBox});
      const std::vector<std::uint32_t> cap = cap_vertices(closed, volume.lattice());
      ASSERT_GT(cap.size(), 100U);
      ASSERT_EQ(cap.size(), closed.n_vertices() - open.n_vertices()) << "all that the cap added";
      EXPECT_EQ(boundary_edges(closed), 0);
      const std::set<std::uint32_t> of_cap(cap.begin(), cap.end());
      for (const auto v : closed.vertices()) {
        if (!of_cap.contains(std::uint32_t(v.idx()))) {
          EXPECT_EQ(closed.normal(v), open.normal(v)) << "the rim's included";
          continue;
        }
        // Of the unit cube's faces: a coordinate of 0 has -1, one of 1 has 1, of one length.
        const Vec3 p = point(closed, v);
        const Vec3 outward = glm::normalize(glm::step(1.0 - 1e-5, p) - glm::step(-1e-5, -p));
        EXPECT_LT(glm::distance(normal(closed, v), outward), 1e-6);
      }
    }
  }
}

TEST(Cap, OfAFarObliqueBoxIsTold) {
  Volume volume = noise(Index3(9, 8, 7), 3);
  Lattice lattice = volume.lattice();
  lattice.frame.axes[1] = Vec3(0.3, -2.0, 0.1);
  lattice.frame.origin = Vec3(1000.0, -2000.0, 300.0);
  volume.values = Grid<float>(lattice, {volume.values.values().begin(), volume.values.values().end()});
  const IsoMesh open = extract(volume, "marching_cubes", {.isovalue = 0.5f});
  const IsoMesh closed = extract(volume, "marching_cubes", {.isovalue = 0.5f, .cap = CapKind::kBox});
  EXPECT_EQ(cap_vertices(closed, lattice).size(), closed.n_vertices() - open.n_vertices());
  EXPECT_TRUE(cap_vertices(open, lattice).empty());
}

}  // namespace
}  // namespace isolux
