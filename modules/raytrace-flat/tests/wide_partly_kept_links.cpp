// Links of which a part of the rays is kept: the others are traced for the last reflection.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/raytrace_flat/light_links.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "cell_sites.h"
#include "physics_support.h"

namespace isolux::test {
namespace {

class PartlyKeptLinks : public testing::TestWithParam<RayNets> {
 protected:
  PartlyKeptLinks() { sites_ = cell_sites(volume_, OuterSide::kLower, texel_); }

  [[nodiscard]] LightLinks links(int rays, int kept) const {
    return {volume_, sites_, {.rays = rays, .kept = kept, .nets = GetParam()}, isolux::Run{}};
  }
  [[nodiscard]] Scene half_lit() const {
    Scene scene = furnace(0.8f);
    scene.environment = half_sky({0.0f, 0.0f, 1.0f});
    return scene;
  }

  Volume volume_ = gyroid(17);
  std::vector<std::size_t> texel_;
  Sites sites_;
};

// Without reflections what is kept makes no difference: the same rays, added up in another order.
TEST_P(PartlyKeptLinks, SeeTheSameSky) {
  for (const int rays : {32, 50}) {
    const SampleSet all = links(rays, 0).direct(half_lit(), {}, isolux::Run{}).samples;
    const SampleSet some = links(rays, 8).direct(half_lit(), {}, isolux::Run{}).samples;
    ASSERT_EQ(all.variance.size(), some.variance.size());
    for (std::size_t i = 0; i < all.variance.size(); ++i) EXPECT_NEAR(all.radiance[i], some.radiance[i], 1e-6f);
  }
}

// Reflections are iterated over fewer rays: the difference is the noise of these in the mean over all ends, which for a
// spread of e of .3 and 8 rays is at most .3 / sqrt(8) / sqrt(64), with the albedo .01 and some more for all bounces.
TEST_P(PartlyKeptLinks, ReflectTheSameLight) {
  const Solution all = links(64, 0).solve(half_lit(), {}, {}, isolux::Run{});
  const Solution some = links(64, 8).solve(half_lit(), {}, {}, isolux::Run{});
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const double d = double(some.samples.radiance[i]) - double(all.samples.radiance[i]);
    sum += d;
    squares += d * d;
  }
  const auto count = double(sites_.size());
  EXPECT_LT(std::sqrt(squares / count), 0.015);
  EXPECT_LT(std::abs(sum / count), 0.003);
  EXPECT_GT(squares, 0.0);
  EXPECT_GT(some.counters.rays, 56 * sites_.size());  // probes are traced as well
  EXPECT_EQ(all.counters.rays, 0u);
}

// Nor does it matter much whether sweeps read all ends or one of four, and the light of a furnace is the same exactly.
TEST_P(PartlyKeptLinks, IterateOverSomeEnds) {
  const LightLinks all = links(64, 0);
  const auto e = [&](const Scene& scene, std::size_t one_of) {
    return all.solve(scene, {.ends_one_of = one_of}, {}, isolux::Run{}).samples.radiance;
  };
  const std::vector<float> exact = e(half_lit(), 1);
  const std::vector<float> some = e(half_lit(), 4);
  double squares = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) squares += std::pow(double(some[i]) - double(exact[i]), 2.0);
  EXPECT_LT(std::sqrt(squares / double(exact.size())), 0.008);  // as above, with sqrt(16)
  EXPECT_GT(squares, 0.0);
  Scene white = furnace(0.5f);
  white.emission = {.keys = {{0.0f, Vec3f(0.5f)}}};
  // Iteration ends when .002 of e is left to come.
  for (const float value : e(white, 4)) EXPECT_NEAR(value, 1.0f, 0.004f);
}

TEST_P(PartlyKeptLinks, TakeLessMemory) { EXPECT_LT(links(64, 8).bytes(), links(64, 0).bytes() / 3); }

TEST_P(PartlyKeptLinks, GiveTheSameBitsForAnyNumberOfThreads) {
  const auto light = [&](int threads) {
    isolux::Run run;
    run.threads = threads;
    const LightLinks links(volume_, sites_, {.rays = 32, .kept = 8, .nets = GetParam()}, run);
    const SampleSet samples = links.solve(half_lit(), {}, {}, run).samples;
    return std::pair(samples.radiance, samples.variance);
  };
  EXPECT_EQ(light(1), light(3));
}

INSTANTIATE_TEST_SUITE_P(Nets, PartlyKeptLinks, testing::Values(RayNets::kIndependent, RayNets::kInterleaved));

TEST(PartlyKept, AreClosed) {
  const Volume volume = gyroid(9);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  LightLinks links(volume, sites, {.rays = 16, .kept = 4}, isolux::Run{});
  const std::vector<std::uint32_t> first{0};
  EXPECT_THROW(links.extend(first, isolux::Run{}), InvalidInput);
  for (const int kept : {-1, 3, 32})
    EXPECT_THROW(LightLinks(volume, sites, {.rays = 16, .kept = kept}, isolux::Run{}), InvalidInput) << kept;
}

// The parts of a site's rays are those of the whole.
TEST(PartlyKept, RaysAreThoseOfTheWholeNet) {
  const Volume volume = gyroid(9);
  std::vector<std::size_t> texel;
  const Sites sites = cell_sites(volume, OuterSide::kLower, texel);
  const auto directions = [&](int first, int rays) {
    std::vector<std::vector<float>> found(sites.size());
    std::mutex adding;
    const GatherSettings settings{.rays = rays, .all_rays = 16, .first_ray = first, .nets = RayNets::kInterleaved};
    (void)gather(volume, sites, settings, isolux::Run{}, [&](const GatheredRays& gathered) {
      const std::scoped_lock lock(adding);
      for (std::size_t place = 0; place < gathered.sites.size(); ++place) {
        const auto* begin = &gathered.direction[0][place * gathered.rays];
        found[gathered.sites[place]].assign(begin, begin + gathered.rays);
      }
    });
    return found;
  };
  const auto whole = directions(0, 16);
  const auto first = directions(0, 4);
  const auto rest = directions(4, 12);
  for (std::size_t site = 0; site < sites.size(); ++site) {
    std::vector<float> both = first[site];
    both.insert(both.end(), rest[site].begin(), rest[site].end());
    EXPECT_EQ(both, whole[site]);
  }
}

}  // namespace
}  // namespace isolux::test
