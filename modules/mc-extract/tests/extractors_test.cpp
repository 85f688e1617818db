#include <gtest/gtest.h>
#include <isolux/mc_extract.h>

#include <OpenMesh/Tools/Utils/MeshCheckerT.hh>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <sstream>

namespace isolux {
namespace {

Volume sample(const Index3& size, const IndexToWorld& frame, const std::function<float(const Vec3&)>& f) {
  Volume volume;
  volume.values = Grid<float>(Lattice{.size = size, .frame = frame});
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) volume.values(i, j, k) = f(frame.world(Vec3(i, j, k)));
  return volume;
}

TEST(Extractors, MakeClosedSpheres) {
  const auto registry = extractors();
  for (const auto& info : registry.backends()) {
    const auto extractor = registry.create(info.name);
    IndexToWorld frame{.origin = Vec3(0.0), .axes = Mat3(1.0 / 31)};
    const Volume v = sample(Index3(32), frame, [](const Vec3& p) { return -float(glm::length(p - Vec3(0.5))); });
    const IsoMesh mesh = extractor->extract(v, {.isovalue = -0.3f}, {});
    EXPECT_EQ(int(mesh.n_vertices()) - int(mesh.n_edges()) + int(mesh.n_faces()), 2) << info.name;
    double volume = 0;
    for (auto f : mesh.faces()) {
      Vec3 p[3];
      int n = 0;
      for (auto x : mesh.fv_range(f)) {
        auto q = mesh.point(x);
        p[n++] = Vec3(q[0], q[1], q[2]);
      }
      volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6;
    }
    EXPECT_NEAR(volume, 4.0 / 3 * 3.14159 * .027, 1e-3) << info.name;
    for (auto x : mesh.vertices()) {
      auto q = mesh.point(x);
      auto n = mesh.normal(x);
      EXPECT_GT(glm::dot(Vec3(n[0], n[1], n[2]), Vec3(q[0], q[1], q[2]) - Vec3(.5)), .29) << info.name;
      EXPECT_FALSE(mesh.is_boundary(x));
    }
    IsoMesh m = mesh;
    OpenMesh::Utils::MeshCheckerT<IsoMesh> checker(m);
    std::ostringstream out;
    EXPECT_TRUE(checker.check(OpenMesh::Utils::MeshCheckerT<IsoMesh>::CHECK_ALL, out)) << out.str().substr(0, 1000);
  }
}

}  // namespace
}  // namespace isolux
