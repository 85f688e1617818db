// Light on caps: that of a face of the box, which nothing stands before.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace isolux::test {
namespace {

constexpr int kSide = 9;

/// Half of the unit cube is inside: f = x, oblique if `shear` is not 0.
Volume ramp(double shear = 0.0) {
  Lattice lattice{.size = Index3(kSide), .frame = {}};
  lattice.frame.axes = Mat3(1.0 / (kSide - 1));
  lattice.frame.axes[1].x = shear / (kSide - 1);
  Volume volume;
  volume.values = Grid<float>(lattice);
  for (int k = 0; k < kSide; ++k)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) volume.values(i, j, k) = float(i) / float(kSide - 1);
  return volume;
}

struct LitCap {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;
  PointLight light;
};

LitCap lit_cap(const Volume& volume, const Scene& scene, const std::string& tracer) {
  const IsoMesh mesh = extractors().create()->extract(volume, {.isovalue = 0.45f, .cap = CapKind::kBox}, isolux::Run{});
  LitCap cap;
  for (const std::uint32_t v : cap_vertices(mesh, volume.lattice())) {
    const auto& p = mesh.point(OpenMesh::VertexHandle(int(v)));
    const auto& n = mesh.normal(OpenMesh::VertexHandle(int(v)));
    cap.positions.emplace_back(p[0], p[1], p[2]);
    cap.normals.emplace_back(n[0], n[1], n[2]);
  }
  cap.light = light_on_box(volume.lattice(), scene, cap.positions, cap.normals, {}, {tracer, {}}, builtin_stages(),
                           isolux::Run{});
  return cap;
}

class LightOnBox : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Tracers, LightOnBox, ::testing::Values("wide", "scalar"),
                         [](const auto& tracer) { return tracer.param; });

TEST_P(LightOnBox, IsThatOfAnEmptySky) {
  // Under the half sky e = (1 + n.up)/2, wherever on the cap, edges of the box included.
  Scene scene;
  const Vec3f up(1.0f, 0.0f, 0.0f);
  scene.environment = SkyEnvironment{.up = up};
  for (const double shear : {0.0, 0.4}) {
    const LitCap cap = lit_cap(ramp(shear), scene, GetParam());
    ASSERT_GT(cap.positions.size(), 200U);
    for (std::size_t i = 0; i < cap.positions.size(); ++i)
      EXPECT_NEAR(cap.light.radiance[i].x, 0.5f * (1.0f + glm::dot(cap.normals[i], up)), 2e-3f);  // 16384 rays
  }
  const LitCap white = lit_cap(ramp(), {}, GetParam());
  for (const Vec3f& e : white.light.radiance) EXPECT_FLOAT_EQ(e.x, 1.0f);
}

TEST_P(LightOnBox, IsThatOfSunsAndLampsToo) {
  // Straight above the face z = 1: a sun of irradiance 2 gives 2/pi, a ball of radius r and radiance L at distance d
  // with the angle a from the normal L cos(a) (r/d)^2.
  Scene scene;
  scene.environment = UniformEnvironment{.radiance = Vec3f(0.0f)};
  scene.lights.push_back(SunLight{.direction = {0.0f, 0.0f, 1.0f}, .irradiance = Vec3f(2.0f)});
  const Vec3 centre(0.5, 0.5, 2.0);
  scene.lights.push_back(SphereLight{.center = centre, .radius = 0.25f, .radiance = {4.0f, 0.0f, 0.0f}});
  const LitCap cap = lit_cap(ramp(), scene, GetParam());
  int on_top = 0;
  for (std::size_t i = 0; i < cap.positions.size(); ++i) {
    if (cap.normals[i].z < 0.999f) continue;
    const double distance = glm::distance(Vec3(cap.positions[i]), centre);
    const double ball = 4.0 * (1.0 / distance) * std::pow(0.25 / distance, 2);
    EXPECT_NEAR(cap.light.radiance[i].y, 2.0 * std::numbers::inv_pi, 1e-3);
    EXPECT_NEAR(cap.light.radiance[i].x, 2.0 * std::numbers::inv_pi + ball, 0.01);  // 64 rays aimed at the ball
    ++on_top;
  }
  EXPECT_GT(on_top, 20);
}

TEST(LightOnBoxOf, NothingIsNothing) {
  const Lattice box{.size = Index3(4), .frame = {}};
  EXPECT_TRUE(light_on_box(box, {}, {}, {}, {}, {}, builtin_stages(), isolux::Run{}).radiance.empty());
  const std::vector<Vec3f> one(1, Vec3f(0.0f));
  EXPECT_THROW((void)light_on_box(box, {}, one, {}, {}, {}, builtin_stages(), isolux::Run{}), InvalidInput);
}

/// A sky, and a lamp above the face z = 1 of an oblique box.
Scene lamp_scene() {
  Scene scene;
  scene.environment = SkyEnvironment{.up = {1.0f, 0.0f, 0.0f}};
  scene.lights.push_back(SphereLight{.center = {0.5, 0.5, 2.0}, .radius = 0.25f, .radiance = Vec3f(4.0f)});
  return scene;
}

TEST(BoxLight, IsLightOnBoxAtGridPointsAndLinearBetween) {
  const Volume volume = ramp(0.4);
  const Lattice& lattice = volume.lattice();
  const TraceSettings settings{.rays = 1024};
  const BoxLight light(lattice, lamp_scene(), settings, {}, builtin_stages(), isolux::Run{});
  EXPECT_GT(light.counters().rays, 0U);
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const Vec3 upwards = glm::normalize(lattice.frame.gradient_to_world()[axis]);
    Vec3 at(2.0, 3.0, 5.0);
    at[axis] = face % 2 == 0 ? 0.0 : kSide - 1;
    Vec3 next = at;
    next[(axis + 2) % 3] += 1.0;
    const std::vector<Vec3f> positions = {Vec3f(lattice.frame.world(at)), Vec3f(lattice.frame.world(next))};
    const std::vector<Vec3f> normals(2, Vec3f(face % 2 == 0 ? -upwards : upwards));
    const PointLight known =
        light_on_box(lattice, lamp_scene(), positions, normals, settings, {}, builtin_stages(), isolux::Run{});
    EXPECT_NEAR(light.at(face, at).x, known.radiance[0].x, 0.01) << face;  // each of 1024 rays aimed at the ball
    EXPECT_NEAR(light.at(face, next).x, known.radiance[1].x, 0.01) << face;
    EXPECT_NEAR(light.at(face, 0.75 * at + 0.25 * next).x,
                0.75f * light.at(face, at).x + 0.25f * light.at(face, next).x, 1e-5)
        << face;
  }
}

TEST(BoxLight, IsOneAFaceWithoutLamps) {
  const Volume volume = ramp();
  Scene scene = lamp_scene();
  scene.lights.clear();
  const BoxLight light(volume.lattice(), scene, {}, {}, builtin_stages(), isolux::Run{});
  EXPECT_EQ(light.at(4, {1.0, 2.0, 0.0}), light.at(4, {7.5, 0.0, 0.0}));
  EXPECT_NEAR(light.at(1, {8.0, 2.0, 3.0}).x, 1.0, 2e-3);  // under the half sky e = (1 + n.up)/2, of 16384 rays
  EXPECT_NEAR(light.at(4, {1.0, 2.0, 0.0}).x, 0.5, 2e-3);
}

}  // namespace
}  // namespace isolux::test
