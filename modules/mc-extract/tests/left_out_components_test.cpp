// What is left out of a mesh is told at places of the level set.
#include <gtest/gtest.h>
#include <isolux/mc_extract.h>

#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <set>
#include <tuple>
#include <vector>

#include "fields.h"

namespace isolux {
namespace {

using namespace isolux::testing;

/// A place on each triangle of `mesh`, index space: near a corner, so that it is told from other triangles.
std::vector<Vec3> places_on(const IndexedMesh& mesh, const IndexToWorld& frame) {
  std::vector<Vec3> places;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 world =
        0.4 * Vec3(mesh.positions[t[0]]) + 0.4 * Vec3(mesh.positions[t[1]]) + 0.2 * Vec3(mesh.positions[t[2]]);
    places.push_back(frame.index(world));
  }
  return places;
}

std::set<std::tuple<float, float, float>> vertices_of(const IndexedMesh& mesh) {
  std::set<std::tuple<float, float, float>> vertices;
  for (const Vec3f& p : mesh.positions) vertices.emplace(p.x, p.y, p.z);
  return vertices;
}

// Noise, also of few levels with an isovalue among them: surfaces then keep just off whole planes of grid points.
TEST(LeftOutComponents, AreThoseThatTheMeshLacks) {
  IndexToWorld oblique;
  oblique.axes[1] = Vec3(0.3, -2.0, 0.1);
  oblique.origin = Vec3(10.0, -20.0, 3.0);
  for (const int levels : {0, 5}) {
    for (const CapKind cap : {CapKind::kNone, CapKind::kBox}) {
      Volume volume = noise(Index3(14, 12, 10), 7, levels);
      const Lattice lattice{.size = volume.lattice().size, .frame = oblique};
      volume.values = Grid<float>(lattice, {volume.values.values().begin(), volume.values.values().end()});
      ExtractSettings settings{.isovalue = levels > 0 ? 4.0f : 0.8f, .cap = cap};
      IsoExtractor extractor(volume);
      IndexedMesh all;
      extractor.extract(settings, isolux::Run{}, all);
      settings.min_component = 60;
      IndexedMesh kept;
      extractor.extract(settings, isolux::Run{}, kept);
      const auto kept_vertices = vertices_of(kept);
      const LeftOutComponents left_out(extractor, lattice, settings, isolux::Run{});
      const std::vector<Vec3> places = places_on(all, oblique);
      std::size_t many = 0;
      for (std::size_t t = 0; t < places.size(); ++t) {
        const Vec3f& corner = all.positions[all.triangles[t][0]];
        const bool is_kept = kept_vertices.contains({corner.x, corner.y, corner.z});
        EXPECT_EQ(left_out.contain(places[t]), !is_kept) << levels << " levels, triangle " << t;
        if (!is_kept) ++many;
      }
      EXPECT_GT(many, 500U);
      EXPECT_GT(places.size() - many, 200U);
    }
  }
}

TEST(LeftOutComponents, AreNoneWhereNothingIsSmall) {
  const Volume volume = ball(16);
  IsoExtractor extractor(volume);
  const LeftOutComponents none(extractor, volume.lattice(), {.isovalue = -0.3f, .min_component = 2}, isolux::Run{});
  const LeftOutComponents all(extractor, volume.lattice(), {.isovalue = -0.3f, .min_component = 1000000},
                              isolux::Run{});
  const Vec3 on_it(7.5, 7.5, 7.5 + 0.3 * 15.0);
  EXPECT_FALSE(none.contain(on_it));
  EXPECT_TRUE(all.contain(on_it));
  EXPECT_TRUE(none.contain(Vec3(7.5))) << "on no triangle";
}

// Two boxes of whole voxels: all of their faces lie exactly in planes of grid points, where rays meet them.
TEST(LeftOutComponents, AreToldOnPlanesOfGridPoints) {
  const Volume volume = sampled(Index3(16), {}, [](const Vec3& p) {
    const auto within = [&p](double low, double high) {
      return p.x >= low && p.x <= high && p.y >= low && p.y <= high && p.z >= low && p.z <= high;
    };
    return within(2.0, 3.0) || within(6.0, 12.0) ? 1.0 : 0.0;
  });
  IsoExtractor extractor(volume);
  const LeftOutComponents left_out(extractor, volume.lattice(), {.isovalue = 1.0f, .min_component = 100},
                                   isolux::Run{});
  for (const double along : {2.0, 2.3, 3.0}) EXPECT_TRUE(left_out.contain({2.0, along, 2.5})) << along;
  for (const double along : {2.0, 2.3, 3.0}) EXPECT_TRUE(left_out.contain({2.5, along, 3.0})) << along;
  for (const double along : {6.0, 8.5, 12.0}) EXPECT_FALSE(left_out.contain({6.0, along, 9.0})) << along;
}

}  // namespace
}  // namespace isolux
