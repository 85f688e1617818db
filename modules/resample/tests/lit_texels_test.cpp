#include "lit_texels.h"

#include <gtest/gtest.h>
#include <isolux/core/error.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "texel_looks.h"

namespace isolux {
namespace {

constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();

Sites sites_at_places(std::vector<Vec3f> positions) {
  Sites sites;
  sites.isovalues.resize(positions.size());
  sites.normals.resize(positions.size());
  sites.positions = std::move(positions);
  return sites;
}

TEST(LitTexels, AreInTheOrderOfMemoryWhateverTheSitesAre) {
  const Lattice volume{.size = {4, 3, 3}, .frame = {}};
  const Lattice texels = cell_lattice(volume);
  const Sites sites = sites_at_places({{2.5f, 0.5f, 1.5f}, {0.5f, 1.5f, 0.5f}, {2.5f, 0.5f, 1.5f}, {1.5f, 0.5f, 0.5f}});
  const LitTexels lit(volume, sites, texels, {0, 1, 2}, {});
  EXPECT_EQ(lit.sites, (std::vector<std::uint32_t>{3, 1, 0}));
  EXPECT_EQ(lit.of_site, (std::vector<std::uint32_t>{2, 1, 2, 0}));
  EXPECT_EQ(lit.layers, (std::vector<std::uint32_t>{0, 2, 3}));
  EXPECT_EQ(lit.at,
            (std::vector<std::uint32_t>{kNone, 0, kNone, 1, kNone, kNone, kNone, kNone, 2, kNone, kNone, kNone}));
}

TEST(LitTexels, MayBeInTheOrderOfOtherAxes) {
  const Lattice volume{.size = {3, 3, 4}, .frame = {}};
  const Sites sites = sites_at_places({{1.5f, 0.5f, 2.5f}, {0.5f, 1.5f, 0.5f}, {0.5f, 0.5f, 1.5f}});
  const LitTexels lit(volume, sites, cell_lattice(volume), {2, 1, 0}, {});
  EXPECT_EQ(lit.sites, (std::vector<std::uint32_t>{2, 1, 0}));
  EXPECT_EQ(lit.of_site, std::vector<std::uint32_t>());
  EXPECT_EQ(lit.at,
            (std::vector<std::uint32_t>{kNone, 0, kNone, 1, kNone, kNone, kNone, kNone, 2, kNone, kNone, kNone}));
}

TEST(LitTexels, RefuseSitesBetweenThem) {
  const Lattice volume{.size = {4, 3, 3}, .frame = {}};
  EXPECT_THROW(LitTexels(volume, sites_at_places({{2.5f, 0.5f, 1.0f}}), cell_lattice(volume), {0, 1, 2}, {}),
               InvalidInput);
}

TEST(NoisyLight, IsTheMeanOfSeveralSamples) {
  const Lattice volume{.size = {3, 2, 2}, .frame = {}};
  const Sites sites = sites_at_places({{1.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {1.5f, 0.5f, 0.5f}});
  const LitTexels lit(volume, sites, cell_lattice(volume), {0, 1, 2}, {});
  wide::LatticeSamples all;
  all.looks = SampleWindow<float>(wide::LatticeSamples::stride(1));
  all.looks.hold_until(2);
  const std::vector<float> radiance{0.25f, 1.0f, 0.75f};
  const std::vector<float> variance{0.5f, 0.125f, 0.25f};
  NoisyLight(radiance, variance, lit, 1, 2.0f).write(0, 2, {}, all);
  EXPECT_EQ(all.look(0)[wide::LatticeSamples::kLight], 2.0f);
  EXPECT_EQ(all.look(0)[wide::LatticeSamples::kVariance], 0.5f);
  EXPECT_EQ(all.look(1)[wide::LatticeSamples::kLight], 1.0f);
  EXPECT_EQ(all.look(1)[wide::LatticeSamples::kVariance], 0.75f);
}

}  // namespace
}  // namespace isolux
