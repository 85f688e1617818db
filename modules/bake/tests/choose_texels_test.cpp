// The size of the illumination grid by measured error.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/bake/choose_texels.h>
#include <isolux/core/error.h>
#include <isolux/resample.h>
#include <isolux/volume_io/read.h>

#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

namespace isolux::test {
namespace {

const Stages& stages() {
  static const Stages all = builtin_stages();
  return all;
}

BakeSettings without_bounces() {
  BakeSettings settings;
  settings.trace.bounces = 0;
  return settings;
}

TexelChoice choice(const Volume& volume, double target, const BakeSettings& settings = without_bounces()) {
  return choose_texels(volume, {}, settings, target, stages(), {});
}

// Every level set of the sphere that closes inside the box is white and those that the box cuts are too: one number
// would do, and the fewest texels that are tried do.
TEST(ChooseTexels, TakesTheFewestWhereLightIsEven) {
  const TexelChoice chosen = choice(read_volume("gen:sphere:17"), 0.03);
  EXPECT_EQ(chosen.texels, Index3(4));
  EXPECT_LE(chosen.error, 0.03);
}

TEST(ChooseTexels, TakesMoreForLessError) {
  const Volume volume = read_volume("gen:gyroid:20");
  const TexelChoice rough = choice(volume, 0.2);
  const TexelChoice fine = choice(volume, 0.05);
  EXPECT_GT(fine.texels.x, rough.texels.x);
  EXPECT_LE(fine.error, 0.05);
  EXPECT_LE(rough.error, 0.2);
}

// Noise has no texels that serve it: what is chosen must say so.
TEST(ChooseTexels, SaysWhatItMissesTheTargetBy) {
  const TexelChoice chosen = choice(read_volume("gen:noise:12"), 1e-3);
  EXPECT_GT(chosen.error, 0.02);
}

/// What a bake of so many texels is wrong by, read at random points of random level sets.
double error_of_bake(const Volume& volume, const Index3& texels) {
  BakeSettings settings = without_bounces();
  settings.texels = texels;
  settings.trace.rays = 512;
  const BakeResult baked = bake(volume, {}, settings, stages(), {});
  const LightReader reader(volume, baked.light);
  Sites sites = stages().samplers.create("random")->sample(volume, {.count = 1500}, {.seed = 9});
  const auto traced =
      stages().tracers.create("")->trace(volume, {}, std::move(sites), {.rays = 512, .bounces = 0}, {.seed = 10});
  const TrilinearField field(volume);
  double squares = 0.0;
  double total = 0.0;
  for (std::size_t s = 0; s < traced.samples.size(); ++s) {
    const Vec3 at(traced.samples.sites.positions[s]);
    const double weight = glm::length(field.world_gradient(at, GradientKind::kCentralDifferences));
    squares += weight * std::pow(double(reader.at_index(at).x) - double(traced.samples.radiance[s]), 2.0);
    total += weight;
  }
  return std::sqrt(squares / total);
}

// The estimate against a bake of that size, read at other random points: both are a root mean square over a thousand
// points or so, each known to some 5 percent; weights of area and the texels' rays make up the rest of a quarter.
class ForetoldError : public ::testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(ForetoldError, IsThatOfABake) {
  const auto [name, target] = GetParam();
  const Volume volume = read_volume(name);
  const TexelChoice chosen = choice(volume, target);
  EXPECT_NEAR(chosen.error / error_of_bake(volume, chosen.texels), 1.0, 0.25);
}

INSTANTIATE_TEST_SUITE_P(ChooseTexels, ForetoldError,
                         ::testing::Values(std::pair("gen:gyroid:20", 0.06), std::pair("gen:marschner-lobb:32", 0.1),
                                           std::pair("gen:noise:16", 0.1)),
                         [](const auto& field) {
                           std::string name = field.param.first;
                           std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
                           return name;
                         });

/// A mask: 1 in a ball with a slot, 0 outside.
Volume slotted_ball(int n) {
  Volume volume{.values = Grid<float>({.size = Index3(n), .frame = {}}), .name = "mask"};
  const double middle = 0.5 * (n - 1);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 at = Vec3(i, j, k) - middle;
        const bool in_slot = k >= n / 2 && std::abs(at.y) < 2.0;
        volume.values(i, j, k) = glm::length(at) < 0.3 * n && !in_slot ? 1.0f : 0.0f;
      }
  return volume;
}

// Most texels of a mask lie where all is the same, and are filled with the light of others.
TEST(ChooseTexels, ForetellsWhatFilledTexelsAreWrongBy) {
  for (const int n : {24, 28}) {
    for (const double target : {0.1, 0.2}) {
      const Volume volume = slotted_ball(n);
      const TexelChoice chosen = choice(volume, target);
      EXPECT_LE(chosen.error, target);
      EXPECT_NEAR(chosen.error / error_of_bake(volume, chosen.texels), 1.0, 0.25) << n << " " << target;
    }
  }
}

// Of a cube in nothing a few texels may all miss the cells between.
TEST(ChooseTexels, NeverTakesTexelsThatCannotBeLit) {
  for (int n = 10; n < 22; ++n) {
    Volume volume{.values = Grid<float>({.size = Index3(n), .frame = {}}), .name = "cube"};
    for (int k = n / 4; k < n - n / 4; ++k)
      for (int j = n / 4; j < n - n / 4; ++j)
        for (int i = n / 4; i < n - n / 4; ++i) volume.values(i, j, k) = 1.0f;
    BakeSettings settings = without_bounces();
    settings.texels = choice(volume, 0.1).texels;
    settings.trace.rays = 4;
    EXPECT_NO_THROW((void)bake(volume, {}, settings, stages(), {})) << n;
  }
}

// What texels are wrong by does not depend on the rays that the bake will spend: one ray a texel says nothing about its
// own noise.
TEST(ChooseTexels, DoesNotDependOnTheRaysOfTheBake) {
  const Volume volume = read_volume("gen:gyroid:20");
  BakeSettings settings = without_bounces();
  const TexelChoice usual = choice(volume, 0.05, settings);
  settings.trace.rays = 1;
  const TexelChoice one = choice(volume, 0.05, settings);
  EXPECT_EQ(one.texels, usual.texels);
  EXPECT_EQ(one.error, usual.error);
}

// Light that is read with the volume's openness is less wrong between the same texels than light that is not.
TEST(ChooseTexels, CountsTheNearFieldWhereItWillBeRead) {
  const Volume volume = read_volume("gen:marschner-lobb:32");
  BakeSettings settings = without_bounces();
  settings.resampler.settings = {{"near_field", "false"}};
  const double plain = choice(volume, 1e-3, settings).error;
  settings.resampler.settings = {};
  EXPECT_LT(choice(volume, 1e-3, settings).error, 0.95 * plain);
}

// By a small lamp openness would be worth many times the light: no bake reads it so (own_near_field_test).
TEST(ChooseTexels, CountsNoNearFieldThatABakeRejects) {
  const Volume volume = read_volume("gen:cavity:33");
  Scene scene;
  scene.environment = UniformEnvironment{Vec3f(0.0f)};
  scene.lights = {SphereLight{.center = Vec3f(0.5f), .radius = 0.02f, .radiance = Vec3f(100.0f)}};
  BakeSettings settings = without_bounces();
  settings.resampler.settings = {{"near_field", "false"}};
  const TexelChoice plain = choose_texels(volume, scene, settings, 0.05, stages(), {});
  settings.resampler.settings = {};
  const TexelChoice chosen = choose_texels(volume, scene, settings, 0.05, stages(), {});
  EXPECT_EQ(chosen.texels, plain.texels);
  EXPECT_EQ(chosen.error, plain.error);
}

// A texel in the middle of a sphere has no normal: it is no light that is right.
TEST(ChooseTexels, TakesNothingToReadForNoSuccess) {
  const TexelChoice chosen = choice(read_volume("gen:sphere:5"), 0.05);
  EXPECT_GT(chosen.texels.x, 1);
}

TEST(ChooseTexels, KnowsUnevenVolumesAndKnownIsovalues) {
  Volume volume = read_volume("gen:gyroid:20");
  BakeSettings settings = without_bounces();
  settings.isovalues = ValueRange{0.1f, 0.1f};
  const TexelChoice chosen = choice(volume, 0.05, settings);
  EXPECT_GE(chosen.texels.x, 5);
  EXPECT_EQ(texels_by_ratio({.size = {41, 9, 2}, .frame = {}}, 0.25), Index3(10, 2, 1));
  EXPECT_EQ(texels_by_ratio({.size = {41, 9, 2}, .frame = {}}, 1.5), Index3(60, 12, 2));
}

// In the words of a bake.
TEST(ChooseTexels, RefusesConstantVolumesAndIsovaluesBeyondTheValues) {
  const auto why = [](const Volume& volume, const BakeSettings& settings) {
    const auto message = [](const auto& call) {
      try {
        call();
      } catch (const InvalidInput& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    const std::string chosen = message([&] { (void)choice(volume, 0.1, settings); });
    EXPECT_EQ(chosen, message([&] { (void)bake(volume, {}, settings, stages(), {}); }));
    return chosen;
  };
  Volume constant{.values = Grid<float>({.size = Index3(9), .frame = {}}), .name = "threes"};
  for (float& value : constant.values.values()) value = 3.0f;
  EXPECT_EQ(why(constant, without_bounces()), "threes: every voxel is 3; a constant volume has no level set to light");
  BakeSettings beyond = without_bounces();
  beyond.isovalues = ValueRange{100.0f, 200.0f};
  EXPECT_NE(why(read_volume("gen:gyroid:9"), beyond), "");
}

TEST(ChooseTexels, RefusesTexelsAtTheVoxels) {
  BakeSettings settings = without_bounces();
  settings.lattice = TexelLattice::kVoxels;
  EXPECT_THROW(choice(read_volume("gen:sphere:8"), 0.1, settings), InvalidInput);
}

TEST(TexelsByRatio, AreRefusedWhereNoNumberHoldsThem) {
  const Lattice volume{.size = Index3(9), .frame = {}};
  EXPECT_EQ(texels_by_ratio(volume, 0.75), Index3(6));
  EXPECT_EQ(texels_by_ratio(volume, 1e-9), Index3(1));
  for (const double ratio : {3e8, 1e12, HUGE_VAL, 0.0, -1.0, std::nan("")})
    EXPECT_THROW((void)texels_by_ratio(volume, ratio), InvalidInput) << ratio;
  BakeSettings settings = without_bounces();
  settings.texels_a_cell = 3e8;
  EXPECT_THROW((void)bake(read_volume("gen:gyroid:9"), {}, settings, stages(), {}), InvalidInput);
}

}  // namespace
}  // namespace isolux::test
