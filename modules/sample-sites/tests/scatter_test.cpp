#include <gtest/gtest.h>
#include <isolux/sample_sites.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "test_volumes.h"

namespace isolux {
namespace {

Sites sample(const std::string& backend, const Volume& volume, std::size_t count, std::uint64_t seed = 1,
             std::optional<ValueRange> isovalues = std::nullopt) {
  const SiteRequest request{.texels = cell_lattice(volume.lattice()), .count = count, .isovalues = isovalues};
  return samplers().create(backend)->sample(volume, request, {.seed = seed});
}

double slope(const Vec3& p) { return p.x + 0.5 * p.y - 0.7 * p.z; }

/// What holds for the backends that scatter `count` sites.
class Scatter : public testing::TestWithParam<std::string> {};

TEST_P(Scatter, DensityIsUniformInTheWorld) {
  const Volume volume = index_volume({17, 9, 33}, slope);
  const Sites sites = sample(GetParam(), volume, 64000);
  std::vector<double> bins(8 * 4 * 16);
  for (const Vec3f& p : sites.positions) {
    const std::size_t row = 4 * std::size_t(std::min(int(p.z / 2), 15)) + std::size_t(std::min(int(p.y / 2), 3));
    bins[8 * row + std::size_t(std::min(int(p.x / 2), 7))] += 1;
  }
  const double expected = double(sites.size()) / double(bins.size());
  double chi_squared = 0.0;
  for (const double n : bins) chi_squared += (n - expected) * (n - expected) / expected;
  // 511 degrees of freedom: mean 511, deviation 32; six deviations above. Even points stay far below, which is fine.
  EXPECT_LT(chi_squared, 511.0 + 6 * 32.0);
}

TEST_P(Scatter, DensityIsUniformInTheCellsOfARange) {
  // A slab of cells whose part inside the range is known: x in [4.25, 9.5] of a field that is x.
  const Volume volume = index_volume({17, 13, 13}, [](const Vec3& p) { return p.x; });
  const Sites sites = sample(GetParam(), volume, 42000, 3, ValueRange{.low = 4.25f, .high = 9.5f});
  EXPECT_NEAR(double(sites.size()), 42000.0, 0.03 * 42000.0);  // the pilot of `stratified` knows the share to 1 %
  std::vector<double> bins(21 * 6);
  for (const Vec3f& p : sites.positions) {
    bins[6 * std::size_t(std::min(int((p.x - 4.25f) * 4), 20)) + std::size_t(std::min(int(p.y / 2), 5))] += 1;
  }
  const double expected = double(sites.size()) / double(bins.size());
  double chi_squared = 0.0;
  for (const double n : bins) chi_squared += (n - expected) * (n - expected) / expected;
  EXPECT_LT(chi_squared, 125.0 + 6 * 15.8);  // 125 degrees of freedom, six deviations
}

TEST_P(Scatter, DeliversTheCountInsideANarrowRange) {
  const Volume volume = index_volume({21, 21, 21}, [](const Vec3& p) { return -glm::length(p - Vec3(10.0)); });
  const Sites sites = sample(GetParam(), volume, 5000, 1, ValueRange{.low = -6.01f, .high = -6.0f});
  // `stratified` estimates the share from the few dozen hits of its pilot.
  EXPECT_NEAR(double(sites.size()), 5000.0, 1500.0);
}

TEST_P(Scatter, SitesAreNotWastedOnFlatParts) {
  const Volume volume = index_volume({33, 9, 9}, [](const Vec3& p) { return std::max(0.0, p.x - 24.0); });
  const Sites sites = sample(GetParam(), volume, 2000);
  EXPECT_NEAR(double(sites.size()), 2000.0, 100.0);  // strata are whole numbers on each axis
  for (const Vec3f& p : sites.positions) EXPECT_GE(p.x, 24.0f);
}

TEST_P(Scatter, OtherSeedsGiveOtherSites) {
  const Volume volume = index_volume({9, 9, 9}, slope);
  EXPECT_NE(sample(GetParam(), volume, 100, 1).positions, sample(GetParam(), volume, 100, 2).positions);
}

/// Root mean squared error over seeds of the mean of a smooth function at the sites against its mean over the region.
double integration_error(const std::string& backend, std::size_t count, std::optional<ValueRange> isovalues) {
  const Volume volume = index_volume({13, 13, 13}, [](const Vec3& p) { return p.x; });
  const double low = isovalues ? double(isovalues->low) : 0.0;
  const double high = isovalues ? double(isovalues->high) : 12.0;
  const auto primitive = [](double x) { return -std::cos(0.4 * x) / 0.4; };
  const double sine_mean = (primitive(high) - primitive(low)) / (high - low);
  const double truth = sine_mean + (primitive(12.0) - primitive(0.0)) / 12.0 * 6.0;
  double sum = 0.0;
  constexpr int kSeeds = 24;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Sites sites = sample(backend, volume, count, seed, isovalues);
    double mean = 0.0;
    for (const Vec3f& p : sites.positions)
      mean += std::sin(0.4 * double(p.x)) + std::sin(0.4 * double(p.y)) * double(p.z);
    mean /= double(sites.size());
    sum += (mean - truth) * (mean - truth);
  }
  return std::sqrt(sum / kSeeds);
}

TEST(LowDiscrepancy, BeatsRandomOnIntegrals) {
  for (const std::optional<ValueRange> range : {std::optional<ValueRange>{}, {{.low = 2.0f, .high = 7.5f}}}) {
    const double random = integration_error("random", 2000, range);
    // The error falls as N^-1/2 for random, N^-5/6 for jittered and nearly N^-1 for even points: at N = 2000 factors of
    // 12 and 45 up to constants near one, against which 4 and 2 leave room for chance (24 seeds: 15 %).
    EXPECT_GT(random / integration_error("low_discrepancy", 2000, range), 4.0);
    EXPECT_GT(random / integration_error("stratified", 2000, range), 2.0);
  }
}

TEST(Stratified, PutsOneSiteInEachStratum) {
  const Volume volume = index_volume({9, 9, 9}, slope);
  const Sites sites = sample("stratified", volume, 512);
  ASSERT_EQ(sites.size(), 512u);
  std::vector<int> bins(512);
  for (const Vec3f& p : sites.positions) ++bins[64 * std::size_t(p.z) + 8 * std::size_t(p.y) + std::size_t(p.x)];
  for (const int n : bins) EXPECT_EQ(n, 1);
}

// Voxels of .5 x 1 x 2: as many strata a unit of length along each axis.
TEST(Stratified, HasStrataThatAreCubesInTheWorld) {
  Volume volume = index_volume({9, 9, 9}, slope);
  Lattice lattice = volume.lattice();
  for (int a = 0; a < 3; ++a) lattice.frame.axes[a][a] = 0.5 * (1 << a);
  volume.values = Grid<float>(lattice, {volume.values.values().begin(), volume.values.values().end()});
  const Sites sites = sample("stratified", volume, 512);
  ASSERT_EQ(sites.size(), 512u);
  std::vector<int> bins(512);
  for (const Vec3f& p : sites.positions)
    ++bins[32 * std::size_t(2.0f * p.z) + 4 * std::size_t(p.y) + std::size_t(0.5f * p.x)];
  for (const int n : bins) EXPECT_EQ(n, 1);
}

TEST(Texels, SitAtTheTexelCentresInOrder) {
  const Volume volume = index_volume({5, 4, 3}, slope);
  const auto at = [&](const Lattice& texels) {
    return samplers().create("texels")->sample(volume, {.texels = texels, .count = 7}, {}).positions;
  };
  const auto cells = at(cell_lattice(volume.lattice()));
  ASSERT_EQ(cells.size(), 24u);
  EXPECT_EQ(cells[0], Vec3f(0.5f));
  EXPECT_EQ(cells[1], Vec3f(1.5f, 0.5f, 0.5f));
  EXPECT_EQ(cells[4], Vec3f(0.5f, 1.5f, 0.5f));
  EXPECT_EQ(cells[12], Vec3f(0.5f, 0.5f, 1.5f));
  const auto voxels = at(voxel_lattice(volume.lattice()));
  ASSERT_EQ(voxels.size(), 60u);
  EXPECT_EQ(voxels[59], Vec3f(4, 3, 2));
}

INSTANTIATE_TEST_SUITE_P(Backends, Scatter, testing::Values("random", "stratified", "low_discrepancy"),
                         [](const auto& backend) { return backend.param; });

}  // namespace
}  // namespace isolux
