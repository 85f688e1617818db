// The whole way from a volume to light read at the vertices of a mesh, against exact answers.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/light_file.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>

namespace isolux {
namespace {

constexpr double kHalfEdge = 0.5;  // of the box of gen: fields

Scene scene_of_albedo(float albedo) {
  Scene scene;
  scene.albedo.keys[0].colour = Vec3f(albedo);
  return scene;
}

/// Root mean square of e - exact over the mesh vertices of the level sets `radii` of gen:cavity.
double cavity_error(const Volume& volume, const IlluminationGrid& light, const std::vector<double>& radii,
                    double albedo, const Stages& stages) {
  const auto extractor = stages.extractors.create();
  double sum = 0.0;
  std::size_t count = 0;
  for (const double radius : radii) {
    const IsoMesh mesh = extractor->extract(volume, {.isovalue = float(radius)}, {});
    const double open = 3.0 * (1.0 - kHalfEdge / radius);
    const double exact = open / (1.0 - albedo * (1.0 - open));
    for (const auto vertex : mesh.vertices()) {
      const auto& p = mesh.point(vertex);
      const double error = double(light.at_world({double(p[0]), double(p[1]), double(p[2])}).x) - exact;
      sum += error * error;
      ++count;
    }
  }
  EXPECT_GT(count, 0U);
  return std::sqrt(sum / double(count));
}

class OpenIntegratingSphere : public testing::TestWithParam<float> {};

TEST_P(OpenIntegratingSphere, IsLitRightThroughTheWholePipeline) {
  const float albedo = GetParam();
  const Volume volume = read_volume("gen:cavity:64");
  const Stages stages = builtin_stages();
  BakeSettings settings;
  settings.trace.rays = 64;
  settings.isovalues =
      ValueRange{0.5f, 0.70f};  // a texel beyond the surfaces that are read, for the interpolation between texels
  const BakeResult baked = bake(volume, scene_of_albedo(albedo), settings, stages, {});
  // .02 is what the project promises; noise of 64 rays, averaged by the interpolation, takes about .012 of it.
  EXPECT_LT(cavity_error(volume, baked.light, {0.54, 0.57, 0.60, 0.63, 0.66}, double(albedo), stages), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Albedo, OpenIntegratingSphere, testing::Values(0.5f, 0.8f));

// Nothing is brighter than a white sky where all surfaces are white; an acceleration of the bounces made it 1.05.
TEST(WhiteFurnace, IsNowhereBrighterThanItsSky) {
  const Volume volume = read_volume("gen:noise:11");
  BakeSettings settings;
  settings.trace.rays = 32;
  const BakeResult baked = bake(volume, scene_of_albedo(1.0f), settings, builtin_stages(), {});
  for (const float e : baked.light.values) EXPECT_LE(e, 1.0f + 1e-6f);
}

TEST(Bake, LightsAConvexLevelSetByOneOnEveryLattice) {
  const Volume volume = read_volume("gen:sphere:24");
  const Stages stages = builtin_stages();
  for (const bool voxels : {false, true}) {
    BakeSettings settings;
    settings.trace.rays = 16;
    settings.trace.bounces = 0;
    settings.lattice = voxels ? TexelLattice::kVoxels : TexelLattice::kCells;
    const BakeResult baked = bake(volume, Scene{}, settings, stages, {});
    for (const double radius : {0.2, 0.3, 0.4}) {
      const Vec3f e = baked.light.at_world(Vec3(0.5) + radius * glm::normalize(Vec3(1.0, 2.0, -0.5)));
      // The trilinear sphere of 24^3 has faint creases that catch a ray here and there.
      EXPECT_NEAR(e.x, 1.0, 0.03) << radius << " voxels " << voxels;
    }
  }
}

TEST(Bake, SamplersAndResamplersAgreeOnASmoothField) {
  const Volume volume = read_volume("gen:two-spheres:24");
  const Stages stages = builtin_stages();
  BakeSettings settings;
  settings.trace.rays = 64;
  settings.trace.bounces = 0;
  const BakeResult direct = bake(volume, Scene{}, settings, stages, {});
  for (const char* sampler : {"random", "stratified", "low_discrepancy"}) {
    settings.sampler.name = sampler;
    settings.samples = 20000;
    const BakeResult scattered = bake(volume, Scene{}, settings, stages, {});
    double sum = 0.0;
    for (std::size_t t = 0; t < direct.light.values.size(); ++t) {
      const double d = double(direct.light.values[t]) - double(scattered.light.values[t]);
      sum += d * d;
    }
    // Both have the noise of 64 rays (at most .06 a texel, smoothed in the scattered one) and the blur of Shepard's
    // weights at the crease.
    EXPECT_LT(std::sqrt(sum / double(direct.light.values.size())), 0.06) << sampler;
  }
}

TEST(LightPoints, TellTheTextureWhatItShouldSay) {
  const Volume volume = read_volume("gen:two-spheres:32");
  const Stages stages = builtin_stages();
  const IsoMesh mesh = stages.extractors.create()->extract(volume, {.isovalue = -0.15f}, {});
  std::vector<Vec3f> points;
  for (const auto v : mesh.vertices()) points.emplace_back(mesh.point(v)[0], mesh.point(v)[1], mesh.point(v)[2]);
  const PointLight light = light_points(volume, Scene{}, points, {.rays = 256, .bounces = 0}, {}, stages, {});
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    // e = 1 - cos(a) (r/d)^2 where the other ball lies wholly above the horizon (docs/theory.md).
    const Vec3 p(points[i]);
    const Vec3 own = p.x < 0.5 ? Vec3(0.3, 0.5, 0.5) : Vec3(0.7, 0.5, 0.5);
    const Vec3 other = Vec3(1.0, 1.0, 1.0) - own;
    const Vec3 n = glm::normalize(p - own);
    const double d = glm::length(other - p);
    const double cosine = glm::dot(n, other - p) / d;
    if (cosine * d < 0.15 + 0.02) continue;
    const double error = double(light.radiance[i].x) - (1.0 - cosine * 0.15 * 0.15 / (d * d));
    sum += error * error;
    ++count;
  }
  ASSERT_GT(count, 50U);
  // Noise of 256 rays is at most .03 (binomial at e = 1/2), less where stratified; the trilinear balls of 32^3 differ
  // by .01.
  EXPECT_LT(std::sqrt(sum / double(count)), 0.03);
}

TEST(LightFile, KeepsWhatLetsLightBeReadFinely) {
  const Volume volume = read_volume("gen:two-spheres:16");
  for (const bool fit : {true, false}) {
    BakeSettings settings;
    settings.sampler.name = fit ? "stratified" : "texels";
    settings.resampler.name = fit ? "fit" : "direct";
    settings.samples = 8 * 15 * 15 * 15;
    settings.trace.rays = fit ? 4 : 32;
    settings.trace.bounces = 0;
    LightFile light;
    light.grid = bake(volume, Scene{}, settings, builtin_stages(), {}).light;
    ASSERT_EQ(light.grid.detail.slopes.empty(), !fit);
    ASSERT_FALSE(light.grid.detail.near_field.empty());
    const std::string path = testing::TempDir() + "detail.nrrd";
    write_light(light, path, volume.space);
    const LightFile back = read_light(path);
    std::filesystem::remove(path);
    EXPECT_EQ(back.grid.values, light.grid.values);
    EXPECT_EQ(back.grid.detail.slopes, light.grid.detail.slopes);
    const LightReader before(volume, light.grid);
    const LightReader after(volume, back.grid);
    for (const double x : {3.1, 7.4, 11.9}) {
      EXPECT_EQ(before.at_index({x, 6.3, 8.8}).x,
                after.at_index({x, 6.3, 8.8}).x);  // numbers are written to all their digits
    }
  }
}

// A ball under the half sky: e = (1 + n.up)/2. The trilinear ball of 24^3 differs from the round one by .01, 16 rays at
// each of eight sites a cell leave .02, and the file keeps the range that tells where there is light.
TEST(Bake, FitsKnownIsovaluesAloneAndInBricks) {
  const Volume volume = read_volume("gen:sphere:40");
  Scene scene;
  scene.environment = SkyEnvironment{.zenith = Vec3f(1.0f), .horizon = Vec3f(1.0f), .ground = Vec3f(0.0f)};
  for (const ValueRange range : {ValueRange{-0.3f, -0.3f}, ValueRange{-0.32f, -0.28f}}) {
    BakeSettings settings;
    settings.isovalues = range;
    settings.resampler.name = "fit";
    settings.trace.rays = 16;
    settings.trace.bounces = 0;
    const LightFile light = make_light_file(bake(volume, scene, settings, builtin_stages(), {}), volume, scene, {});
    const std::string path = testing::TempDir() + "range.nrrd";
    write_light(light, path, volume.space, {.compress = true});
    const LightFile back = read_light(path);
    std::filesystem::remove(path);
    ASSERT_TRUE(back.grid.detail.isovalues.has_value());
    EXPECT_EQ(back.grid.detail.isovalues->low, range.low);
    const LightReader reader(volume, back.grid, TexelStorage::kBricks);
    ASSERT_NE(reader.bricks(), nullptr);
    double sum = 0.0;
    for (int i = 0; i < 400; ++i) {
      const double z = -0.995 + 0.005 * i;
      const double side = std::sqrt(1.0 - z * z);
      const Vec3 n(side * std::cos(2.4 * i), side * std::sin(2.4 * i), z);
      const double d = double(reader.at_world(Vec3(0.5) + 0.3 * n).x) - 0.5 * (1.0 + z);
      sum += d * d;
    }
    EXPECT_LT(std::sqrt(sum / 400.0), 0.03);
  }
}

TEST(SceneFile, SurvivesARoundTrip) {
  const std::string text = R"({"albedo":{"by_isovalue":[[0,0.5,0.5,0.5],[1,0.25,0.5,0.75]]},"emission":[0,0,0.5],
    "environment":{"type":"sky","up":[0,1,0],"zenith":[1,1,1],"horizon":[0.5,0.5,0.5],"ground":[0,0,0]},
    "lights":[{"type":"sun","direction":[1,0,0],"irradiance":[1,1,1]},
              {"type":"rectangle","center":[0,0,2],"u":[1,0,0],"v":[0,1,0],"radiance":[2,2,2]},
              {"type":"sphere","center":[0,0,3],"radius":0.5,"radiance":[4,4,4]}],"outer":"higher"})";
  const std::string once = scene_to_json(parse_scene(text, "", "test"));
  EXPECT_EQ(scene_to_json(parse_scene(once, "", "test")), once);
  EXPECT_NE(once.find("by_isovalue"), std::string::npos);
}

TEST(Bake, RefusesWhatItCannotLight) {
  const Stages stages = builtin_stages();
  Volume constant = read_volume("gen:sphere:8");
  for (float& v : constant.values.values()) v = 3.0f;
  EXPECT_THROW(static_cast<void>(bake(constant, Scene{}, {}, stages, {})), InvalidInput);
  BakeSettings wrong;
  wrong.resampler.name = "none such";
  EXPECT_THROW(static_cast<void>(bake(read_volume("gen:sphere:8"), Scene{}, wrong, stages, {})), InvalidInput);
}

}  // namespace
}  // namespace isolux
