// Light traced at points that somebody gives.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <limits>
#include <vector>

namespace isolux::test {
namespace {

PointLight lit_points(const Volume& volume, const std::vector<Vec3f>& points) {
  TraceSettings settings;
  settings.rays = 256;
  settings.bounces = 0;
  return light_points(volume, {}, points, settings, {}, builtin_stages(), isolux::Run{});
}

TEST(LightPoints, OnTheBoxsFacesAreBlockedLikeOthers) {
  // Inside an open sphere e is .5 at this radius wherever the sky is seen through the box's faces (theory.md). As
  // floats of this world vertices on the faces lie up to 1e-6 voxel outside.
  Volume volume = read_volume("gen:cavity:33");
  Lattice moved = volume.lattice();
  moved.frame = {.origin = Vec3(-125.0, -119.3, -350.2), .axes = Mat3(0.488281)};
  volume.values = Grid<float>(moved, {volume.values.values().begin(), volume.values.values().end()});
  const IsoMesh mesh = extractors().create()->extract(volume, {.isovalue = 0.6f}, isolux::Run{});
  std::vector<Vec3f> points;
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    points.emplace_back(p[0], p[1], p[2]);
  }
  int on_faces = 0;
  const PointLight light = lit_points(volume, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 index = moved.frame.index(Vec3(points[i]));
    for (int a = 0; a < 3; ++a) on_faces += int(index[a] < 1e-4 || index[a] > 32 - 1e-4);
    EXPECT_NEAR(light.radiance[i].x, 0.5f, 0.06f) << index.x << ' ' << index.y << ' ' << index.z;
  }
  EXPECT_GT(on_faces, 300);
}

TEST(LightPoints, ThatAreNoNumbersAreRefused) {
  const Volume volume = read_volume("gen:sphere:8");
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    EXPECT_THROW(lit_points(volume, {Vec3f(0.2f), Vec3f(0.2f, bad, 0.2f)}), InvalidInput);
  // Far away is the nearest point of the box.
  const PointLight far = lit_points(volume, {Vec3f(0.0f), Vec3f(-1e6f)});
  EXPECT_NEAR(far.radiance[0].x, far.radiance[1].x, 0.05f);
}

}  // namespace
}  // namespace isolux::test
