#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat/scene.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bright_parts.h"
#include "directions.h"
#include "environment.h"
#include "path_sampler.h"
#include "physics_support.h"

namespace isolux::test {
namespace {

TEST(IsovalueColour, IsLinearBetweenKeysAndConstantBeyond) {
  const IsovalueColour colour{.keys = {{1.0f, Vec3f(0.0f)}, {3.0f, Vec3f(1.0f, 0.5f, 0.0f)}, {4.0f, Vec3f(1.0f)}}};
  EXPECT_EQ(colour.at(-5.0f), Vec3f(0.0f));
  EXPECT_EQ(colour.at(1.0f), Vec3f(0.0f));
  EXPECT_EQ(colour.at(2.0f), Vec3f(0.5f, 0.25f, 0.0f));
  EXPECT_EQ(colour.at(3.0f), Vec3f(1.0f, 0.5f, 0.0f));
  EXPECT_EQ(colour.at(99.0f), Vec3f(1.0f));
}

TEST(Scene, IsGreyUntilAnythingHasAColour) {
  const Vec3f red(1.0f, 0.5f, 0.5f);
  EXPECT_TRUE(is_grey(Scene{}));
  std::vector<Scene> coloured(6);
  coloured[0].environment = UniformEnvironment{red};
  coloured[1].environment = SkyEnvironment{.ground = red};
  coloured[2].environment = ImageEnvironment{.width = 2, .height = 1, .pixels = {Vec3f(1.0f), red}};
  coloured[3].lights = {SphereLight{.radiance = red}};
  coloured[4].albedo.keys[0].colour = red;
  coloured[5].emission.keys[0].colour = red;
  for (const Scene& scene : coloured) EXPECT_FALSE(is_grey(scene));
}

TEST(Scene, WhatCannotBeLitIsNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto message = [](const Scene& scene) -> std::string {
    try {
      require_valid(scene);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(Scene{}), "");
  Scene scene;
  scene.albedo = constant(1.25f);
  EXPECT_THAT(message(scene), testing::HasSubstr("albedo = 1.25"));
  scene = {};
  scene.albedo.keys.clear();
  EXPECT_THAT(message(scene), testing::HasSubstr("albedo has no keys"));
  scene = {};
  scene.emission = {.keys = {{2.0f, Vec3f(1.0f)}, {1.0f, Vec3f(1.0f)}}};
  EXPECT_THAT(message(scene), testing::HasSubstr("must rise"));
  scene = {};
  scene.environment = UniformEnvironment{Vec3f(nan)};
  EXPECT_THAT(message(scene), testing::HasSubstr("environment radiance"));
  scene.environment = SkyEnvironment{.up = Vec3f(0.0f)};
  EXPECT_THAT(message(scene), testing::HasSubstr("sky up"));
  scene.environment = ImageEnvironment{};
  EXPECT_THAT(message(scene), testing::HasSubstr("0x0"));
  scene = {};
  scene.lights = {RectangleLight{.u = {1, 0, 0}, .v = {2, 0, 0}}};
  EXPECT_THAT(message(scene), testing::HasSubstr("parallel"));
  scene.lights = {SphereLight{.radius = -1.0f}};
  EXPECT_THAT(message(scene), testing::HasSubstr("sphere radius = -1"));
  scene.lights = {SunLight{.direction = Vec3f(0.0f)}};
  EXPECT_THAT(message(scene), testing::HasSubstr("sun direction"));
}

TEST(Environment, SkyBlendsBySineOfElevation) {
  const SkyEnvironment sky{
      .up = {0.0f, 2.0f, 0.0f}, .zenith = Vec3f(4.0f), .horizon = Vec3f(2.0f), .ground = Vec3f(1.0f)};
  EXPECT_EQ(environment_radiance(sky, {0, 1, 0}), Vec3f(4.0f));
  EXPECT_EQ(environment_radiance(sky, {1, 0, 0}), Vec3f(2.0f));
  EXPECT_NEAR(environment_radiance(sky, {std::sqrt(0.75), 0.5, 0}).x, 3.0, 1e-6);
  EXPECT_EQ(environment_radiance(sky, {0, -1, 0}), Vec3f(1.0f));
}

// Four columns look along -x+y, x+y, x-y, -x-y for up = z.
TEST(Environment, AnImageIsSeenFromWithin) {
  const ImageEnvironment image{
      .width = 4,
      .height = 2,
      .pixels = {Vec3f(1), Vec3f(2), Vec3f(3), Vec3f(4), Vec3f(5), Vec3f(6), Vec3f(7), Vec3f(8)}};
  const double s = 0.5;
  const double z = std::sqrt(0.5);
  EXPECT_NEAR(environment_radiance(image, {-s, s, z}).x, 1.0, 1e-5);
  EXPECT_NEAR(environment_radiance(image, {s, s, z}).x, 2.0, 1e-5);
  EXPECT_NEAR(environment_radiance(image, {s, -s, z}).x, 3.0, 1e-5);
  EXPECT_NEAR(environment_radiance(image, {-s, -s, z}).x, 4.0, 1e-5);
  EXPECT_NEAR(environment_radiance(image, {s, s, -z}).x, 6.0, 1e-5);
  EXPECT_NEAR(environment_radiance(image, {-1, 0, 0}).x, (1.0 + 4.0 + 5.0 + 8.0) / 4.0, 1e-5);  // wraps
  EXPECT_NEAR(environment_radiance(image, {0, 0, 1}).x, 2.5, 2.0);                              // any column's
}

TEST(Environment, ImageSamplesHaveTheDensityTheyState) {
  ImageEnvironment image{.up = {0.3f, 0.2f, 1.0f}, .width = 8, .height = 5, .pixels = {}};
  RandomStream random(1, 1);
  for (int i = 0; i < 40; ++i) image.pixels.emplace_back(float(random.uniform_double() < 0.7 ? 0.0 : i));
  const Environment environment = image;
  const PreparedEnvironment prepared(environment);
  ASSERT_TRUE(prepared.has_samples());
  double luminous = 0.0;
  double sphere = 0.0;
  constexpr int kDraws = 1 << 14;
  const PathSampler numbers(1, 1);
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const UnitPair pair = numbers.pair(i, 0);
    const auto sample = prepared.sample(pair.u, pair.v);
    ASSERT_NEAR(glm::length(sample.towards), 1.0, 1e-12);
    ASSERT_NEAR(prepared.density(sample.towards) / sample.density, 1.0, 1e-6);
    luminous += prepared.radiance(sample.towards).x / sample.density / kDraws;
    const double z = 1.0 - 2.0 * pair.u;
    const double r = std::sqrt(1.0 - z * z);
    const Vec3 even(r * std::cos(2.0 * std::numbers::pi * pair.v), r * std::sin(2.0 * std::numbers::pi * pair.v), z);
    sphere += prepared.radiance(even).x * 4.0 * std::numbers::pi / kDraws;
  }
  // Two estimates of the whole light; 16384 strata leave about a thousandth.
  EXPECT_NEAR(luminous, sphere, 0.005 * sphere);
}

TEST(Environment, BlackOnesDoNotShine) {
  const Environment dark = UniformEnvironment{Vec3f(0.0f)};
  EXPECT_FALSE(EnvironmentView(dark).shines());
  const Environment black = ImageEnvironment{.width = 1, .height = 1, .pixels = {Vec3f(0.0f)}};
  EXPECT_FALSE(PreparedEnvironment(black).shines());
  EXPECT_FALSE(PreparedEnvironment(black).has_samples());
}

TEST(Environment, OnlyWhatIsMuchBrighterIsPartedFromAnImage) {
  Scene scene = furnace(0.5f);
  EXPECT_EQ(&SceneParts(scene).soft(), &scene);
  EXPECT_EQ(SceneParts(scene).bright(), nullptr);
  ImageEnvironment image{.width = 8, .height = 4, .pixels = std::vector<Vec3f>(32, {0.5f, 0.25f, 1.0f})};
  image.pixels[9] = {1.5f, 1.0f, 1.0f};  // some three times the mean, as clouds are
  scene.environment = image;
  EXPECT_EQ(SceneParts(scene).bright(), nullptr);
  EXPECT_FALSE(has_lamps(scene));
  image.pixels[12] = {900.0f, 800.0f, 0.0f};
  scene.environment = image;
  EXPECT_TRUE(has_lamps(scene));
  const SceneParts parts(scene);
  ASSERT_NE(parts.bright(), nullptr);
  const auto& soft = std::get<ImageEnvironment>(parts.soft().environment);
  const auto& bright = std::get<ImageEnvironment>(*parts.bright());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    EXPECT_EQ(bright.pixels[i] == Vec3f(0.0f), i != 12) << i;
    const Vec3f sum = soft.pixels[i] + bright.pixels[i];
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(sum[c], image.pixels[i][c]) << i;
  }
}

// Four rows of .383, .924, .924 and .383 of the sphere's breadth, all of luminance 1 but one: that of the first row is
// above four times the mean from 8.243 on, that of the second is so much of the sky that it never is.
TEST(Environment, TheMeanIsOfTheSphere) {
  const auto is_parted = [](std::size_t row, float bright) {
    ImageEnvironment image{.width = 1, .height = 4, .pixels = std::vector<Vec3f>(4, Vec3f(1.0f))};
    image.pixels[row] = Vec3f(bright);
    Scene scene = furnace(0.5f);
    scene.environment = image;
    return SceneParts(scene).bright() != nullptr;
  };
  for (const std::size_t row : {0, 3}) {
    EXPECT_FALSE(is_parted(row, 8.2f));
    EXPECT_TRUE(is_parted(row, 8.3f));
  }
  EXPECT_FALSE(is_parted(1, 1e6f));
}

// In base 2, any 2^m consecutive paths from a multiple of 2^m have one point in every elementary box of area 2^-m.
TEST(PathSampler, IsANetInEveryPairOfDimensions) {
  for (const std::uint64_t site : {0ull, 1ull, 12345678901ull}) {
    const PathSampler numbers(7, site);
    for (const std::uint32_t dimension : {0u, 3u, 17u}) {
      for (int m = 0; m <= 8; ++m) {
        for (int columns = 0; columns <= m; ++columns) {
          std::vector<int> boxes(std::size_t(1) << m, 0);
          const std::uint32_t begin = 3u << m;
          for (std::uint32_t i = 0; i < (1u << m); ++i) {
            const UnitPair pair = numbers.pair(begin + i, dimension);
            ASSERT_TRUE(pair.u >= 0.0 && pair.u < 1.0 && pair.v >= 0.0 && pair.v < 1.0);
            const auto x = std::size_t(std::ldexp(pair.u, columns));
            const auto y = std::size_t(std::ldexp(pair.v, m - columns));
            ++boxes[(y << columns) + x];
          }
          for (const int count : boxes) ASSERT_EQ(count, 1);
        }
      }
    }
  }
}

TEST(PathSampler, PairsAndSitesAreIndependent) {
  // Correlations of 4096 products of centered uniforms are below 5 standard errors, 5/12/64.
  double across_pairs = 0.0;
  double across_sites = 0.0;
  for (std::uint32_t i = 0; i < 64; ++i) {
    for (std::uint64_t site = 0; site < 64; ++site) {
      const double u = PathSampler(1, site).pair(i, 0).u - 0.5;
      across_pairs += u * (PathSampler(1, site).pair(i, 1).u - 0.5) / 4096.0;
      across_sites += u * (PathSampler(1, site + 64).pair(i, 0).u - 0.5) / 4096.0;
    }
  }
  EXPECT_LT(std::abs(across_pairs), 5.0 / 12.0 / 64.0);
  EXPECT_LT(std::abs(across_sites), 5.0 / 12.0 / 64.0);
}

TEST(Directions, FramesAreOrthonormalAndRightHanded) {
  RandomStream random(2, 2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 z = i == 0 ? Vec3(0, 0, -1) : random_direction(random);
    const Frame frame = frame_about(z);
    EXPECT_NEAR(glm::length(glm::cross(frame.x, frame.y) - z), 0.0, 1e-12);
    EXPECT_NEAR(glm::dot(frame.x, frame.y), 0.0, 1e-12);
    EXPECT_NEAR(glm::length(frame.x), 1.0, 1e-12);
  }
}

TEST(Directions, CosineAndConeHaveTheirMoments) {
  double cosine = 0.0;
  double cone = 0.0;
  constexpr int kSide = 64;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double u = (i + 0.5) / kSide;
      const double v = (j + 0.5) / kSide;
      const Vec3 a = cosine_direction(u, v);
      const Vec3 b = cone_direction(u, v, 0.3);
      EXPECT_NEAR(glm::length(a), 1.0, 1e-12);
      EXPECT_NEAR(glm::length(b), 1.0, 1e-12);
      EXPECT_GE(b.z, 0.7);
      cosine += a.z / (kSide * kSide);
      cone += b.z / (kSide * kSide);
    }
  }
  // Midpoint sums; the square root at the cosine's rim leaves 1/4096 of the rim.
  EXPECT_NEAR(cosine, 2.0 / 3.0, 2e-3);
  EXPECT_NEAR(cone, 0.85, 1e-3);
}

}  // namespace
}  // namespace isolux::test
