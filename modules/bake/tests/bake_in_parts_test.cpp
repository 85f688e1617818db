// Lighting some isovalues after others, against lighting them all at once.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace isolux::test {
namespace {

BakeResult bake_of_parts(const Volume& volume, const Scene& scene, BakeSettings settings, int parts, int threads = 2) {
  settings.isovalue_parts = parts;
  return bake(volume, scene, settings, builtin_stages(), {.threads = threads});
}

BakeSettings sixteen_rays() {
  BakeSettings settings;
  settings.trace.rays = 16;
  settings.trace.bounces = 0;
  settings.wants_error_grid = true;
  return settings;
}

struct PartsCase {
  const char* name;
  std::function<void(Scene&, BakeSettings&)> choose;
};

std::vector<PartsCase> parts_cases() {
  return {{"white sky", [](Scene&, BakeSettings&) {}},
          {"colours",
           [](Scene& scene, BakeSettings&) {
             scene.environment = UniformEnvironment{{.2f, .5f, 1.0f}};
           }},
          {"at the voxels", [](Scene&, BakeSettings& s) { s.lattice = TexelLattice::kVoxels; }},
          {"fewer texels", [](Scene&, BakeSettings& s) { s.texels = Index3(9, 11, 7); }},
          {"more texels than cells", [](Scene&, BakeSettings& s) { s.texels = Index3(16); }},
          {"a range", [](Scene&, BakeSettings& s) {
             s.isovalues = ValueRange{-0.4f, 0.3f};
           }}};
}

TEST(BakeInParts, GivesTheLightOfAllAtOnceBitByBit) {
  // Nets of rays follow from where sites are, not from their number; nothing else of a part is random.
  const Volume volume = read_volume("gen:gyroid:16");
  for (const PartsCase& way : parts_cases()) {
    Scene scene;
    BakeSettings settings = sixteen_rays();
    way.choose(scene, settings);
    const BakeResult whole = bake_of_parts(volume, scene, settings, 1);
    for (const int parts : {2, 7}) {
      const BakeResult pieces = bake_of_parts(volume, scene, settings, parts);
      EXPECT_EQ(pieces.light.values, whole.light.values) << way.name << ", parts " << parts;
      EXPECT_EQ(pieces.sites, whole.sites) << way.name;
      EXPECT_EQ(pieces.unlit_texels, whole.unlit_texels) << way.name;
      EXPECT_EQ(pieces.skipped, whole.skipped) << way.name;
      EXPECT_EQ(pieces.light.detail.near_field.size(), whole.light.detail.near_field.size()) << way.name;
      // Each part finds anew by how much the variance of its nets is thought too large, from some hundred sites: to
      // some 5 % (choose_probes()).
      EXPECT_NEAR(pieces.rmse_estimate, whole.rmse_estimate, 0.15 * whole.rmse_estimate) << way.name;
      ASSERT_TRUE(pieces.error.has_value()) << way.name;
      EXPECT_EQ(pieces.error->values.size(), whole.error->values.size()) << way.name;
    }
  }
}

TEST(BakeInParts, DoesNotDependOnThreads) {
  const Volume volume = read_volume("gen:marschner-lobb:16");
  const BakeResult one = bake_of_parts(volume, {}, sixteen_rays(), 5, 1);
  const BakeResult three = bake_of_parts(volume, {}, sixteen_rays(), 5, 3);
  EXPECT_EQ(one.light.values, three.light.values);
  EXPECT_EQ(one.error->values, three.error->values);
  EXPECT_EQ(one.rmse_estimate, three.rmse_estimate);
}

TEST(BakeInParts, LightsVolumesOfFewValues) {
  // Steps between plateaus: many texels of one isovalue, and none at all of what lies between.
  Volume volume = read_volume("gen:sphere:12");
  for (float& value : volume.values.values()) value = value > 0.1f ? 3.0f : value > -0.1f ? 1.0f : 0.0f;
  const BakeResult whole = bake_of_parts(volume, {}, sixteen_rays(), 1);
  const BakeResult pieces = bake_of_parts(volume, {}, sixteen_rays(), 32);
  EXPECT_GT(whole.unlit_texels, 0u);
  EXPECT_EQ(pieces.light.values, whole.light.values);
  EXPECT_EQ(pieces.skipped, whole.skipped);
}

/// Random numbers of aimed rays and of reflections are keyed by a site's number, which is another one in a part.
void expect_equal_but_for_noise(const Scene& scene, const BakeSettings& settings, const char* what) {
  const Volume volume = read_volume("gen:two-spheres:16");
  const BakeResult whole = bake_of_parts(volume, scene, settings, 1);
  const BakeResult pieces = bake_of_parts(volume, scene, settings, 6);
  double squares = 0.0;
  double light = 0.0;
  double difference = 0.0;
  for (std::size_t t = 0; t < whole.light.values.size(); ++t) {
    const double d = double(pieces.light.values[t]) - double(whole.light.values[t]);
    squares += d * d;
    difference += d;
    light += double(whole.light.values[t]);
  }
  const auto texels = double(whole.light.values.size());
  EXPECT_GT(light / texels, 0.05) << what;
  // Two independent estimates differ by the root of two times the error of each, their means by much less.
  EXPECT_LT(std::sqrt(squares / texels), 2.0 * whole.rmse_estimate) << what;
  EXPECT_LT(std::abs(difference / texels), 0.1 * whole.rmse_estimate) << what;
}

TEST(BakeInParts, SeesSunsAndReflectionsAsAllAtOnceDoes) {
  Scene sunny;
  sunny.environment = UniformEnvironment{Vec3f(0.0f)};
  sunny.lights = {SunLight{.direction = {0.3f, 0.2f, 1.0f}, .irradiance = Vec3f(3.0f), .angular_diameter_deg = 4.0f}};
  expect_equal_but_for_noise(sunny, sixteen_rays(), "sun");
  Scene reflecting;
  reflecting.albedo = {.keys = {{0.0f, Vec3f(0.8f)}}};
  BakeSettings paths = sixteen_rays();
  paths.trace.bounces = 1;
  paths.bounce_method = BounceMethod::kPaths;
  expect_equal_but_for_noise(reflecting, paths, "one reflection by paths");
}

TEST(BakeInParts, LightsAnIsovalueThatNoTexelHas) {
  const Volume volume = read_volume("gen:sphere:12");
  BakeSettings settings = sixteen_rays();
  settings.isovalues = ValueRange{-0.5f, -0.5f};
  const BakeResult parts = bake_of_parts(volume, {}, settings, 4);
  EXPECT_GT(parts.sites, 100u);
  EXPECT_LT(parts.sites, 11u * 11u * 11u);
  EXPECT_EQ(parts.sites, bake_of_parts(volume, {}, settings, 1).sites);
}

}  // namespace
}  // namespace isolux::test
