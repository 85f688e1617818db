// Bounces by iterating on kept hit points, against exact answers and against paths.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat/light_links.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "cell_sites.h"
#include "physics_support.h"

namespace isolux::test {
namespace {

/// e of the samples at their texels. Texels without a site keep 0: the volumes here have at most one, at a centre.
LightLinks::ToGrid at_texels(const Volume& volume, const std::vector<std::size_t>& texel) {
  return [&volume, &texel](const SampleSet& samples) {
    IlluminationGrid grid(cell_lattice(volume.lattice()), samples.channels);
    const auto channels = std::size_t(samples.channels);
    for (std::size_t i = 0; i < samples.size(); ++i)
      for (std::size_t c = 0; c < channels; ++c)
        grid.values[texel[i] * channels + c] = samples.radiance[i * channels + c];
    return grid;
  };
}

TEST(LightLinks, MatchTheOpenIntegratingSphere) {
  const Volume volume = cavity(33);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  const LightLinks links(volume, sites, {.rays = 64}, isolux::Run{});
  const Solution solution = links.solve(furnace(0.8f), {}, at_texels(volume, texel), isolux::Run{});
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const auto radius = double(sites.isovalues[i]);
    if (radius < 0.58 || radius > 0.68) continue;
    const double open = 3.0 * (1.0 - 0.5 / radius);
    const double d = double(solution.samples.radiance[i]) - open / (1.0 - 0.8 * (1.0 - open));
    sum += d;
    squares += d * d;
    ++count;
  }
  ASSERT_GT(count, 500);
  // Bias of reading e from texels of 1/32: e changes with the radius, by up to 5 a unit length at the smallest one, and
  // is averaged over the texels around. Noise: 64 rays of a spread of .3, net strata included, leave .02 at most.
  EXPECT_LT(std::abs(sum / count), 0.006);
  EXPECT_LT(std::sqrt(squares / count), 0.025);
}

TEST(LightLinks, AgreeWithPathsOnTheGyroid) {
  const Volume volume = gyroid(25);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  Scene scene = furnace(0.8f);
  scene.environment = half_sky({0.0f, 0.0f, 1.0f});
  scene.lights.emplace_back(SunLight{.direction = {1.0f, 1.0f, 2.0f}, .irradiance = Vec3f(0.5f)});
  const LightLinks links(volume, sites, {.rays = 64}, isolux::Run{});
  for (const int bounces : {0, 1, kAllBounces}) {
    const Solution solution = links.solve(scene, {.bounces = bounces}, at_texels(volume, texel), isolux::Run{});
    Sites some;
    std::vector<std::size_t> number;
    for (std::size_t i = 0; i < sites.size(); i += 23) {
      some.positions.push_back(sites.positions[i]);
      some.isovalues.push_back(sites.isovalues[i]);
      some.normals.push_back(sites.normals[i]);
      number.push_back(i);
    }
    const SampleSet paths =
        tracers().create("wide")->trace(volume, scene, some, {.rays = 128, .bounces = bounces}, isolux::Run{}).samples;
    double sum = 0.0;
    double mean = 0.0;
    for (std::size_t k = 0; k < number.size(); ++k) {
      sum += double(solution.samples.radiance[number[k]]) - double(paths.radiance[k]);
      mean += double(paths.radiance[k]);
    }
    // 600 sites of some .05 of noise each leave .002 in the mean; texels of 1/24, read by trilinear weights alone,
    // +.007 more.
    EXPECT_LT(std::abs(sum / double(number.size())), 0.006)
        << "bounces " << bounces << ", mean " << mean / double(number.size());
  }
}

/// An image of a sky with a sun of a few pixels, as photographs have them.
ImageEnvironment sunny_image() {
  constexpr int kWidth = 64;
  ImageEnvironment image{.width = kWidth, .height = 32, .pixels = std::vector<Vec3f>(kWidth * 32, Vec3f(0.3f))};
  image.pixels[7 * kWidth + 20] = Vec3f(2000.0f);
  return image;
}

// By chance one ray in a thousand meets such a sun: e of single sites would be wrong by several times the mean.
TEST(LightLinks, AimAtASunInAnImage) {
  const Volume volume = gyroid(17);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  Scene scene = furnace(0.5f);
  scene.environment = sunny_image();
  ASSERT_TRUE(has_lamps(scene));
  const LightLinks links(volume, sites, {.rays = 64}, isolux::Run{});
  for (const int bounces : {0, kAllBounces}) {
    const SampleSet light = links.solve(scene, {.bounces = bounces}, {}, isolux::Run{}).samples;
    const SampleSet paths =
        tracers().create("wide")->trace(volume, scene, sites, {.rays = 256, .bounces = bounces}, isolux::Run{}).samples;
    double sum = 0.0;
    double squares = 0.0;
    double mean = 0.0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const double d = double(light.radiance[i]) - double(paths.radiance[i]);
      sum += d;
      squares += d * d;
      mean += double(paths.radiance[i]);
    }
    const auto n = double(sites.size());
    // Whether a site sees the sun, which is half of its light or more, is told by 64 rays into four pixels: a tenth
    // where its edge is. Reading the reflected light from texels of 1/16 adds to it.
    EXPECT_LT(std::sqrt(squares / n), 0.1 * mean / n) << bounces;
    EXPECT_LT(std::abs(sum / n), 0.015 * mean / n) << bounces;
  }
}

TEST(LightLinks, KeepTheEmissiveFurnaceWhite) {
  const Volume volume = gyroid(17);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  Scene scene = furnace(0.6f);
  scene.emission = constant(0.4f);
  const LightLinks links(volume, sites, {.rays = 16}, isolux::Run{});
  const Solution solution = links.solve(scene, {.tolerance = 1e-6}, at_texels(volume, texel), isolux::Run{});
  // Le = 1 - rho under an environment of 1: radiance 1 everywhere, whatever the rays meet. The tolerance is the change
  // of one sweep, and each sweep leaves .6 of the error at most.
  for (const float e : solution.samples.radiance) EXPECT_NEAR(e, 1.0f, 1e-5f);
}

TEST(LightLinks, LeaveNoMoreThanTheyAreTold) {
  const Volume volume = noise({32, 30, 28}, 3);
  std::vector<std::size_t> texel;
  const LightLinks links(volume, cell_sites(volume, OuterSide::kLower, texel), {.rays = 16}, isolux::Run{});
  Scene coloured = furnace(0.9f);
  coloured.albedo = {.keys = {{0.0f, {0.3f, 0.8f, 0.97f}}}};
  coloured.environment = half_sky({0.0f, 0.0f, 1.0f});
  for (const Scene& scene : {furnace(0.9f), furnace(0.97f), coloured}) {
    const std::vector<float> light = links.solve(scene, {}, {}, isolux::Run{}).samples.radiance;
    const std::vector<float> end = links.solve(scene, {.tolerance = 1e-6}, {}, isolux::Run{}).samples.radiance;
    double left = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < end.size(); ++i) {
      left += double(light[i] - end[i]) * double(light[i] - end[i]);
      squares += double(end[i]) * double(end[i]);
    }
    EXPECT_GT(left, 0.0);
    EXPECT_LT(std::sqrt(left / squares), 0.002);
  }
}

TEST(LightLinks, FindNoMoreReflectionsThanChangeAnything) {
  const Volume volume = gyroid(17);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  const LightLinks links(volume, sites, {.rays = 16}, isolux::Run{});
  const Scene scene = furnace(0.5f);
  const Solution many = links.solve(scene, {.bounces = 1 << 30}, at_texels(volume, texel), isolux::Run{});
  const Solution some = links.solve(scene, {.bounces = 60}, at_texels(volume, texel), isolux::Run{});
  EXPECT_LT(many.sweeps, 60);  // half of the rest a sweep, to the last of 24 bits
  for (std::size_t i = 0; i < sites.size(); ++i) EXPECT_NEAR(many.samples.radiance[i], some.samples.radiance[i], 1e-6f);
}

TEST(LightLinks, ChangeBrightnessWithoutRays) {
  const Volume volume = gyroid(17);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  const LightLinks links(volume, sites, {.rays = 16}, isolux::Run{});
  Scene scene = furnace(0.5f);
  const auto e = [&](float radiance) {
    scene.environment = UniformEnvironment{Vec3f(radiance)};
    const Solution solution = links.solve(scene, {.bounces = 3}, at_texels(volume, texel), isolux::Run{});
    EXPECT_EQ(solution.counters.rays, 0u);
    EXPECT_EQ(solution.sweeps, 3);
    return solution.samples.radiance;
  };
  const auto dim = e(1.0f);
  const auto bright = e(2.0f);
  // Doubling is exact in binary.
  for (std::size_t i = 0; i < dim.size(); ++i) EXPECT_EQ(bright[i], 2.0f * dim[i]);
}

TEST(LightLinks, GiveTheSameBitsForAnyNumberOfThreads) {
  const Volume volume = gyroid(17);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kHigher, texel);
  const auto e = [&](int threads) {
    isolux::Run run;
    run.threads = threads;
    const LightLinks links(volume, sites, {.rays = 16, .outer = OuterSide::kHigher}, run);
    return links.solve(furnace(0.8f, OuterSide::kHigher), {}, at_texels(volume, texel), run).samples;
  };
  const SampleSet one = e(1);
  const SampleSet three = e(3);
  EXPECT_EQ(one.radiance, three.radiance);
  EXPECT_EQ(one.variance, three.variance);
}

TEST(LightLinks, GoOnWithTheirSequences) {
  const Volume volume = gyroid(17);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  for (const LinkEnds ends : {LinkEnds::kKept, LinkEnds::kDropped}) {
    LightLinks doubled(volume, sites, {.rays = 16, .ends = ends}, isolux::Run{});
    std::vector<std::uint32_t> odd;
    for (std::uint32_t i = 1; i < sites.size(); i += 2) odd.push_back(i);
    doubled.extend(odd, isolux::Run{});
    const LightLinks few(volume, sites, {.rays = 16, .ends = ends}, isolux::Run{});
    const LightLinks many(volume, sites, {.rays = 32, .ends = ends}, isolux::Run{});
    const auto e = [](const LightLinks& links) {
      return links.direct(furnace(0.8f), {}, isolux::Run{}).samples.radiance;
    };
    const auto mixed = e(doubled);
    // Counts of rays that escape, over powers of two: exact.
    const auto coarse = e(few);
    const auto fine = e(many);
    for (std::size_t i = 0; i < sites.size(); ++i) EXPECT_EQ(mixed[i], (i % 2 == 0 ? coarse : fine)[i]);
    EXPECT_EQ(doubled.rays()[0], 16u);
    EXPECT_EQ(doubled.rays()[1], 32u);
  }
}

TEST(LightLinks, RefuseBouncesWithoutEnds) {
  const Volume volume = gyroid(9);
  std::vector<std::size_t> texel;
  const LightLinks links(volume, cell_sites(volume, OuterSide::kLower, texel), {.rays = 4, .ends = LinkEnds::kDropped},
                         isolux::Run{});
  EXPECT_THROW((void)links.solve(furnace(0.8f), {}, {}, isolux::Run{}), InvalidInput);
}

TEST(LightLinks, RefuseAnotherOuterSide) {
  const Volume volume = gyroid(9);
  std::vector<std::size_t> texel;
  const LightLinks links(volume, cell_sites(volume, OuterSide::kLower, texel), {.rays = 4}, isolux::Run{});
  EXPECT_THROW((void)links.direct(furnace(0.8f, OuterSide::kHigher), {}, isolux::Run{}), InvalidInput);
}

TEST(LightLinks, FindTheSameLightOnceTheirPlacesAreLetGo) {
  const Volume volume = gyroid(17);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  const LinkSettings settings{.rays = 16, .nets = RayNets::kInterleaved};
  LightLinks links(volume, sites, settings, isolux::Run{});
  const Solution before = links.solve(furnace(0.8f), {}, {}, isolux::Run{});
  ASSERT_TRUE(links.can_let_places_go());
  links.let_places_go();
  const Solution after = links.solve(furnace(0.8f), {}, {}, isolux::Run{});
  EXPECT_EQ(after.samples.radiance, before.samples.radiance);
  EXPECT_EQ(after.samples.variance, before.samples.variance);
  EXPECT_EQ(links.sites().positions.capacity(), 0u);
  Scene sky = furnace(0.8f);
  sky.environment = half_sky({0.0f, 0.0f, 1.0f});
  EXPECT_THROW((void)links.solve(sky, {}, {}, isolux::Run{}), InvalidInput);
  // Rays can be doubled of independent nets: these want their places.
  EXPECT_FALSE(LightLinks(volume, sites, {.rays = 4}, isolux::Run{}).can_let_places_go());
}

}  // namespace
}  // namespace isolux::test
