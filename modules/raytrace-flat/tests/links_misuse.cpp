// What is asked of links, gathers and environments wrongly, or broken off, does no harm.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat.h>

#include <algorithm>
#include <stop_token>
#include <type_traits>
#include <vector>

#include "cell_sites.h"
#include "physics_support.h"

namespace isolux::test {
namespace {

Sites first_sites(const Sites& sites, std::size_t first, std::size_t last) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = first; i < last; ++i) numbers.push_back(i);
  return some_of(sites, numbers);
}

class LinksMisuse : public ::testing::Test {
 protected:
  /// Whatever light the links know.
  void expect_same(const LightLinks& one, const LightLinks& other) const {
    ASSERT_EQ(one.sites().positions, other.sites().positions);
    ASSERT_EQ(one.sites().isovalues, other.sites().isovalues);
    ASSERT_EQ(one.sites().normals, other.sites().normals);
    EXPECT_TRUE(std::equal(one.rays().begin(), one.rays().end(), other.rays().begin(), other.rays().end()));
    EXPECT_EQ(one.counters().rays, other.counters().rays);
    EXPECT_EQ(one.bytes(), other.bytes());
    const SampleSet a = one.direct(scene_, {}, isolux::Run{}).samples;
    const SampleSet b = other.direct(scene_, {}, isolux::Run{}).samples;
    EXPECT_EQ(a.radiance, b.radiance);
    EXPECT_EQ(a.variance, b.variance);
  }
  [[nodiscard]] LightLinks links_of(const Sites& sites) const {
    return LightLinks(volume_, sites, {.rays = 16, .ends = LinkEnds::kAtTexels}, isolux::Run{});
  }

  const Volume volume_ = gyroid(11);
  std::vector<std::size_t> texel_;
  const Sites sites_ = cell_sites(volume_, OuterSide::kLower, texel_);
  const Scene scene_ = furnace(0.5f);
  const std::size_t half_ = sites_.size() / 2;
};

/// A run that is stopped once `reports` were made of it.
class StoppedAfter {
 public:
  explicit StoppedAfter(int reports) : left_(reports) {
    if (left_ == 0) source_.request_stop();
  }
  [[nodiscard]] isolux::Run run() {
    isolux::Run run;
    run.threads = 1;
    run.stop = source_.get_token();
    run.progress = [this](std::string_view, double) {
      if (--left_ <= 0) source_.request_stop();
    };
    return run;
  }

 private:
  int left_;
  std::stop_source source_;
};

TEST_F(LinksMisuse, AnAppendThatIsStoppedLeavesThemAsTheyWere) {
  const Sites some = first_sites(sites_, 0, half_);
  const Sites others = first_sites(sites_, half_, sites_.size());
  const LightLinks never = links_of(some);
  LightLinks twice = links_of(some);
  for (const int reports : {0, 1}) {
    StoppedAfter stopped(reports);
    EXPECT_THROW(twice.append(others, stopped.run()), Cancelled);
    expect_same(twice, never);
  }
  LightLinks once = links_of(some);
  once.append(others, isolux::Run{});
  twice.append(others, isolux::Run{});
  expect_same(twice, once);
}

TEST_F(LinksMisuse, AnExtensionThatIsStoppedLeavesThemAsTheyWere) {
  const LightLinks never = links_of(sites_);
  LightLinks twice = links_of(sites_);
  std::vector<std::uint32_t> numbers(sites_.size());
  for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
  for (const int reports : {0, 1}) {
    StoppedAfter stopped(reports);
    EXPECT_THROW(twice.extend(numbers, stopped.run()), Cancelled);
    expect_same(twice, never);
  }
  LightLinks once = links_of(sites_);
  once.extend(numbers, isolux::Run{});
  twice.extend(numbers, isolux::Run{});
  expect_same(twice, once);
}

TEST_F(LinksMisuse, TheirOwnSitesCanBeAppended) {
  const Sites some = first_sites(sites_, 0, half_);
  LightLinks own = links_of(some);
  own.append(own.sites(), isolux::Run{});
  LightLinks copied = links_of(some);
  copied.append(some, isolux::Run{});
  expect_same(own, copied);
}

TEST_F(LinksMisuse, ArraysOfWrongLengthsAreRefused) {
  Sites uneven = sites_;
  uneven.normals.resize(3);
  EXPECT_THROW((void)links_of(uneven), InvalidInput);
  EXPECT_THROW((void)gather(volume_, uneven, {}, isolux::Run{}, [](const GatheredRays&) {}), InvalidInput);
  LightLinks links = links_of(sites_);
  EXPECT_THROW(links.append(uneven, isolux::Run{}), InvalidInput);
  const auto count = std::uint32_t(sites_.size());
  EXPECT_THROW(links.extend(std::vector<std::uint32_t>{1, count}, isolux::Run{}), InvalidInput);
  EXPECT_THROW(links.extend(std::vector<std::uint32_t>{5, 5}, isolux::Run{}), InvalidInput);
  expect_same(links, links_of(sites_));
  const std::vector<float> few(3, 1.0f);
  EXPECT_THROW((void)links.reflecting(scene_, few, {}, isolux::Run{}), InvalidInput);
  const std::vector<float> enough(cell_lattice(volume_.lattice()).count(), 1.0f);
  EXPECT_NO_THROW((void)links.reflecting(scene_, enough, {}, isolux::Run{}));
  EXPECT_THROW((void)links.reflecting(furnace(0.5f, OuterSide::kHigher), enough, {}, isolux::Run{}), InvalidInput);
}

TEST_F(LinksMisuse, GridsOfReflectedLightThatAreNotCompleteAreRefused) {
  const LightLinks links = links_of(sites_);
  const auto solve = [&](auto spoil) {
    return links.solve(
        scene_, {},
        [&](const SampleSet& samples) {
          IlluminationGrid grid(cell_lattice(volume_.lattice()), samples.channels);
          spoil(grid);
          return grid;
        },
        isolux::Run{});
  };
  EXPECT_NO_THROW((void)solve([](IlluminationGrid&) {}));
  EXPECT_THROW((void)solve([](IlluminationGrid& grid) { grid.values.resize(3); }), InvalidInput);
  EXPECT_THROW((void)solve([](IlluminationGrid& grid) { grid.detail.slopes.resize(3); }), InvalidInput);
}

TEST(Lifetimes, OfATemporaryVolumeDoNotCompile) {
  EXPECT_TRUE((std::is_constructible_v<LevelSetIntersector, const Volume&>));
  EXPECT_FALSE((std::is_constructible_v<LevelSetIntersector, Volume>));
  EXPECT_TRUE((std::is_constructible_v<LightLinks, const Volume&, Sites, LinkSettings, isolux::Run>));
  EXPECT_FALSE((std::is_constructible_v<LightLinks, Volume, Sites, LinkSettings, isolux::Run>));
}

TEST(Environment, ImagesWithoutPixelsAreRefused) {
  for (const ImageEnvironment& image : {ImageEnvironment{}, ImageEnvironment{.width = 2, .height = 2, .pixels = {}}}) {
    EXPECT_THROW((void)environment_radiance(image, {0.0, 0.0, 1.0}), InvalidInput);
    Scene scene;
    scene.environment = image;
    EXPECT_THROW((void)has_lamps(scene), InvalidInput);
  }
}

}  // namespace
}  // namespace isolux::test
