// Both sides of level sets in one bake, against bakes of one side and exact answers.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "analytic_volume.h"

namespace isolux::test {
namespace {

Scene both_sides_scene(float albedo, OuterSide outer = OuterSide::kLower) {
  Scene scene;
  scene.albedo = {.keys = {{0.0f, Vec3f(albedo)}}};
  scene.outer = outer;
  scene.sides = LitSides::kBoth;
  return scene;
}

void expect_same_light(const IlluminationGrid& one, const IlluminationGrid& other, const std::string& what) {
  EXPECT_EQ(one.values, other.values) << what;
  EXPECT_EQ(one.detail.slopes, other.detail.slopes) << what;
  EXPECT_EQ(one.detail.ceiling, other.detail.ceiling) << what;
  ASSERT_EQ(one.detail.near_field.size(), other.detail.near_field.size()) << what;
  for (std::size_t t = 0; t < one.detail.near_field.size(); ++t) {
    EXPECT_EQ(one.detail.near_field[t].step, other.detail.near_field[t].step) << what;
    EXPECT_EQ(one.detail.near_field[t].weight, other.detail.near_field[t].weight) << what;
  }
}

struct Way {
  const char* name;
  std::function<void(BakeSettings&)> choose;
};

/// Every way in which bake() traces and resamples.
std::vector<Way> ways() {
  return {{"kept rays", [](BakeSettings&) {}},
          {"no bounces", [](BakeSettings& s) { s.trace.bounces = 0; }},
          {"paths", [](BakeSettings& s) { s.bounce_method = BounceMethod::kPaths; }},
          {"cell grid", [](BakeSettings& s) { s.samples = 2000; }},
          {"fit", [](BakeSettings& s) { s.resampler.name = "fit"; }},
          {"fit of a range",
           [](BakeSettings& s) {
             s.resampler.name = "fit";
             s.isovalues = ValueRange{-0.2f, 0.3f};
           }},
          {"an error",
           [](BakeSettings& s) {
             s.target_rmse = 0.05;
             s.wants_error_grid = true;
           }},
          {"an error for all sites alike",
           [](BakeSettings& s) {
             s.target_rmse = 0.05;
             s.samples = 500;
           }},
          {"by need, with reflections",
           [](BakeSettings& s) {
             s.target_rmse = 0.05;
             s.texel_sites = TexelSites::kNeeded;
           }},
          {"by need", [](BakeSettings& s) {
             s.target_rmse = 0.05;
             s.trace.bounces = 0;
             s.texel_sites = TexelSites::kNeeded;
             s.wants_error_grid = true;
           }}};
}

TEST(BothSides, AreTheBakesOfEachSideBitByBit) {
  const Volume volume = read_volume("gen:gyroid:12");
  const Stages stages = builtin_stages();
  const Scene scene = both_sides_scene(0.7f);
  for (const Way& way : ways()) {
    BakeSettings settings;
    settings.trace.rays = 8;
    way.choose(settings);
    const BakeResult both = bake(volume, scene, settings, stages, {.threads = 2});
    const BakeResult outer = bake(volume, scene_of_side(scene, LevelSetSide::kOuter), settings, stages, {.threads = 1});
    const BakeResult inner = bake(volume, scene_of_side(scene, LevelSetSide::kInner), settings, stages, {.threads = 1});
    ASSERT_TRUE(both.inner_light.has_value()) << way.name;
    EXPECT_FALSE(outer.inner_light.has_value()) << way.name;
    expect_same_light(both.light, outer.light, way.name);
    expect_same_light(*both.inner_light, inner.light, way.name);
    EXPECT_NE(both.light.values, both.inner_light->values) << way.name;
    if (settings.wants_error_grid) {
      EXPECT_EQ(both.error->values, outer.error->values) << way.name;
      EXPECT_EQ(both.inner_error->values, inner.error->values) << way.name;
    }
    EXPECT_EQ(both.sites, outer.sites + inner.sites) << way.name;
    EXPECT_EQ(both.counters.rays, outer.counters.rays + inner.counters.rays) << way.name;
    ASSERT_EQ(both.sides.size(), 2U) << way.name;
    EXPECT_EQ(both.sides[1].rays, inner.counters.rays) << way.name;
    EXPECT_EQ(both.sides[1].rmse_estimate, inner.rmse_estimate) << way.name;
  }
}

TEST(BothSides, ChangePlacesWithTheOuterSide) {
  const Volume volume = read_volume("gen:marschner-lobb:16");
  const Stages stages = builtin_stages();
  BakeSettings settings;
  settings.trace.rays = 8;
  settings.trace.bounces = 1;
  settings.resampler.name = "fit";
  const BakeResult lower = bake(volume, both_sides_scene(0.7f), settings, stages, {});
  const BakeResult higher = bake(volume, both_sides_scene(0.7f, OuterSide::kHigher), settings, stages, {});
  expect_same_light(lower.light, *higher.inner_light, "lower");
  expect_same_light(*lower.inner_light, higher.light, "higher");
}

/// Rms of e less `exact` over the texels at which that is known, and how many they are.
double error_over(const IlluminationGrid& light, const std::function<double(const Vec3&)>& exact) {
  double sum = 0.0;
  int count = 0;
  for (int z = 0; z < light.lattice.size.z; ++z) {
    for (int y = 0; y < light.lattice.size.y; ++y) {
      for (int x = 0; x < light.lattice.size.x; ++x) {
        const double e = exact(light.lattice.frame.world({x, y, z}));
        if (std::isnan(e)) continue;
        sum += std::pow(double(light.values[light.lattice.offset(x, y, z)]) - e, 2.0);
        ++count;
      }
    }
  }
  EXPECT_GT(count, 100);
  return std::sqrt(sum / count);
}

constexpr double kNoAnswer = std::numeric_limits<double>::quiet_NaN();
double from_middle(const Vec3& p) { return glm::length(p - kCenter); }

// theory.md, answers 3, 6 and 7: a ball is convex from outside, dark inside where it is closed and an open integrating
// sphere inside where the box cuts it, s = 3 (1 - H/R). Texels of a level set that the box just cuts are left out: the
// grid's own sphere is off by a part of a cell.
TEST(BothSides, OfABallAreWhiteOutsideAndAnIntegratingSphereInside) {
  const float albedo = 0.8f;
  BakeSettings settings;
  settings.trace.rays = 64;
  const BakeResult baked = bake(sphere(40), both_sides_scene(albedo), settings, builtin_stages(), {});
  const auto inside = [&](const Vec3& p) {
    const double r = from_middle(p);
    const double open = 3.0 * (1.0 - 0.5 / r);
    return r > 0.55 && r < 0.68 ? open / (1.0 - double(albedo) * (1.0 - open)) : kNoAnswer;
  };
  // Creases of the trilinear ball catch a ray here and there; reflected light gives most of it back.
  EXPECT_LT(error_over(baked.light, [](const Vec3& p) { return from_middle(p) > 0.15 ? 1.0 : kNoAnswer; }), 0.01);
  // No ray leaves a closed ball; what is reflected is read from texels around, some of them of the next level sets, and
  // so a little of the open ones' light comes in from bounce to bounce.
  EXPECT_LT(error_over(*baked.inner_light, [](const Vec3& p) { return from_middle(p) < 0.44 ? 0.0 : kNoAnswer; }),
            0.001);
  // 64 rays of e = .55 to .95: .03 a texel at worst (binomial), a third of it as they are stratified; the rest is the
  // grid's.
  EXPECT_LT(error_over(*baked.inner_light, inside), 0.02);
}

// The same with the sides changed over, and without bounces: then a closed cavity is as black as can be.
TEST(BothSides, OfAnOpenSphereAreWhiteWhereSeenFromOutside) {
  BakeSettings settings;
  settings.trace.rays = 64;
  settings.trace.bounces = 0;
  const BakeResult baked = bake(cavity(32), both_sides_scene(0.5f), settings, builtin_stages(), {});
  EXPECT_LT(error_over(*baked.inner_light, [](const Vec3& p) { return from_middle(p) > 0.55 ? 1.0 : kNoAnswer; }),
            0.01);
  EXPECT_EQ(error_over(baked.light, [](const Vec3& p) { return from_middle(p) < 0.44 ? 0.0 : kNoAnswer; }), 0.0);
}

// Le = 1 - rho and environment 1: outgoing radiance 1 on both sides of anything, e = 1 where it has a normal. The
// solver stops where less than 2e-3 is left to come.
TEST(BothSides, ShineAlikeInTheEmissiveFurnace) {
  Scene scene = both_sides_scene(0.6f);
  scene.emission = {.keys = {{0.0f, Vec3f(0.4f)}}};
  BakeSettings settings;
  settings.trace.rays = 16;
  for (const Volume& volume : {sphere(24), two_spheres(24), gyroid(16)}) {
    const BakeResult baked = bake(volume, scene, settings, builtin_stages(), {});
    const auto one = [](const Vec3&) { return 1.0; };
    EXPECT_LT(error_over(baked.light, one), 0.005);
    EXPECT_LT(error_over(*baked.inner_light, one), 0.005);
  }
}

/// What a point sees of a parallel unit square at a distance, by theory.md, answer 8.
double square_seen(const Vec3& p, double distance) {
  double sum = 0.0;
  for (const double x : {p.x, 1.0 - p.x}) {
    for (const double y : {p.y, 1.0 - p.y}) {
      const double u = x / distance;
      const double v = y / distance;
      const double a = std::sqrt(1.0 + u * u);
      const double b = std::sqrt(1.0 + v * v);
      sum += (u / a * std::atan(v / a) + v / b * std::atan(u / b)) / (2.0 * std::numbers::pi);
    }
  }
  return sum;
}

// f = -|z - c| is lit between its planes from inside and freely from outside; the grid has the kink at its points, so
// that the sampled field is the analytic one.
TEST(BothSides, OfParallelPlanesSeeEachOtherFromInsideAlone) {
  const Volume planes = unit_cube_volume(33, [](const Vec3& p) { return -std::fabs(p.z - kCenter); });
  BakeSettings settings;
  settings.trace.rays = 256;
  settings.trace.bounces = 0;
  const BakeResult baked = bake(planes, both_sides_scene(0.8f), settings, builtin_stages(), {});
  EXPECT_EQ(error_over(baked.light, [](const Vec3&) { return 1.0; }), 0.0);
  const auto between = [](const Vec3& p) { return 1.0 - square_seen(p, 2.0 * std::fabs(p.z - kCenter)); };
  EXPECT_LT(error_over(*baked.inner_light, between), 0.01);  // .03 by binomial noise, less as rays are stratified
}

TEST(BothSides, TakeTheTexelsOfTheSideThatWantsMore) {
  const Volume volume = read_volume("gen:cavity:20");
  const Stages stages = builtin_stages();
  const Scene scene = both_sides_scene(0.5f);
  BakeSettings settings;
  settings.trace.bounces = 0;
  settings.trace.rays = 4;
  const TexelChoice both = choose_texels(volume, scene, settings, 0.05, stages, {});
  const TexelChoice outer =
      choose_texels(volume, scene_of_side(scene, LevelSetSide::kOuter), settings, 0.05, stages, {});
  const TexelChoice inner =
      choose_texels(volume, scene_of_side(scene, LevelSetSide::kInner), settings, 0.05, stages, {});
  EXPECT_EQ(both.texels.x, std::max(outer.texels.x, inner.texels.x));
  EXPECT_EQ(both.error, std::max(outer.error, inner.error));
}

TEST(BothSides, AreRefusedWhereRaysAreKept) {
  const Stages stages = builtin_stages();
  const Volume volume = read_volume("gen:sphere:8");
  EXPECT_THROW(KeptRays(volume, both_sides_scene(0.5f), {}, stages, {}), InvalidInput);
}

TEST(BothSides, AreSaidInTheSceneWhereTheyAreLit) {
  EXPECT_EQ(scene_to_json(Scene{}).find("sides"), std::string::npos);
  const Scene both = parse_scene(R"({"sides": "both"})", "", "test");
  EXPECT_EQ(both.sides, LitSides::kBoth);
  EXPECT_EQ(parse_scene(scene_to_json(both), "", "test").sides, LitSides::kBoth);
  EXPECT_EQ(scene_to_json(parse_scene(R"({"sides": "outer"})", "", "test")), scene_to_json(Scene{}));
  try {
    static_cast<void>(parse_scene(R"({"sides": "inner"})", "", "test"));
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "test.sides: 'inner'; allowed are outer, both");
  }
}

}  // namespace
}  // namespace isolux::test
