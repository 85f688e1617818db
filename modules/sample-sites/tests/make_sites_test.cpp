#include <gtest/gtest.h>
#include <isolux/core/random.h>
#include <isolux/sample_sites.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "test_volumes.h"

namespace isolux {
namespace {

std::vector<Vec3f> scattered(Index3 size, std::size_t count) {
  std::vector<Vec3f> positions;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(7, i);
    const Vec3 u(random.uniform_double(), random.uniform_double(), random.uniform_double());
    positions.emplace_back(u * Vec3(size - 1));
  }
  return positions;
}

double wavy(const Vec3& p) { return std::sin(0.3 * p.x) + std::cos(0.2 * p.y) * std::sin(0.25 * p.z); }

SiteRequest whole(const Volume& volume) { return {.texels = cell_lattice(volume.lattice())}; }

TEST(MakeSites, IsovalueIsTheFieldAtTheFloatPosition) {
  const Volume volume = index_volume({21, 17, 19}, wavy);
  const TrilinearField field(volume);
  const Sites sites = make_sites(volume, scattered(volume.lattice().size, 2000), whole(volume), {});
  ASSERT_EQ(sites.size(), 2000u);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    EXPECT_EQ(sites.isovalues[i], float(field.value(Vec3(sites.positions[i]))));
  }
}

TEST(MakeSites, NormalsArePlanarFieldsGradientsInWorldSpace) {
  // f is linear in the index, so both gradients are exact; a sheared frame with unequal spacing tells whether the
  // covector was transformed as one: the normal must be orthogonal to the world images of in-plane index directions.
  Volume volume = index_volume({9, 9, 9}, [](const Vec3& p) { return 2.0 * p.x - 3.0 * p.y + 0.5 * p.z; });
  Lattice lattice = volume.lattice();
  lattice.frame.axes = Mat3(Vec3(0.5, 0.1, 0.0), Vec3(0.0, 2.0, 0.3), Vec3(0.2, 0.0, 20.0));
  volume.values = Grid<float>(lattice, {volume.values.values().begin(), volume.values.values().end()});
  for (const auto kind : {GradientKind::kCentralDifferences, GradientKind::kCell}) {
    SiteRequest request = whole(volume);
    request.gradient = kind;
    for (const auto outer : {OuterSide::kLower, OuterSide::kHigher}) {
      request.outer = outer;
      const Sites sites = make_sites(volume, scattered(lattice.size, 100), request, {});
      ASSERT_EQ(sites.size(), 100u);
      for (const Vec3f& n : sites.normals) {
        // 1e-6: a unit vector's components in float are good to 6e-8, the images are up to 20 long.
        EXPECT_NEAR(glm::length(Vec3(n)), 1.0, 1e-6);
        EXPECT_NEAR(glm::dot(Vec3(n), lattice.frame.axes * Vec3(3, 2, 0)), 0.0, 3e-6);
        EXPECT_NEAR(glm::dot(Vec3(n), lattice.frame.axes * Vec3(1, 0, -4)), 0.0, 3e-5);
        const double up_the_field = glm::dot(Vec3(n), lattice.frame.axes * Vec3(2, -3, 0.5));
        EXPECT_EQ(up_the_field < 0.0, outer == OuterSide::kLower);
      }
    }
  }
}

TEST(MakeSites, NormalsConvergeToTheAnalyticOnesAtSecondOrder) {
  const auto rms_angle = [](int n) {
    const double scale = 20.0 / (n - 1);
    const Volume volume = index_volume({n, n, n}, [&](const Vec3& p) { return wavy(p * scale); });
    // Away from the faces, where the differences are one-sided.
    std::vector<Vec3f> positions;
    for (const Vec3f& p : scattered({n, n, n}, 4000)) positions.emplace_back(p * 0.8f + 0.1f * float(n - 1));
    const Sites sites = make_sites(volume, positions, whole(volume), {});
    double sum = 0.0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const Vec3 p = Vec3(sites.positions[i]) * scale;
      const Vec3 gradient(0.3 * std::cos(0.3 * p.x), -0.2 * std::sin(0.2 * p.y) * std::sin(0.25 * p.z),
                          0.25 * std::cos(0.2 * p.y) * std::cos(0.25 * p.z));
      if (glm::length(gradient) < 0.05) continue;
      const double d = glm::length(Vec3(sites.normals[i]) + glm::normalize(gradient));
      sum += d * d;
    }
    return std::sqrt(sum / double(sites.size()));
  };
  const double coarse = rms_angle(21);
  const double fine = rms_angle(41);
  EXPECT_LT(coarse, 0.02);
  // Second order divides the error by 4 when n doubles; 3 leaves room for terms of higher order.
  EXPECT_GT(coarse / fine, 3.0);
}

TEST(MakeSites, KeepsTheOrderAndDropsWhatIsOutsideTheRange) {
  const Volume volume = index_volume({11, 2, 2}, [](const Vec3& p) { return p.x; });
  SiteRequest request = whole(volume);
  request.isovalues = ValueRange{.low = 2.0f, .high = 6.0f};
  const Sites sites = make_sites(
      volume, {{5.5f, 0, 0}, {1.5f, 0, 0}, {2.0f, 1, 1}, {6.5f, 0, 0}, {6.0f, 0, 0}, {3.0f, .5f, 0}}, request, {});
  EXPECT_EQ(sites.isovalues, (std::vector<float>{5.5f, 2.0f, 6.0f, 3.0f}));
}

TEST(MakeSites, KeepsEachSitesOwnNormal) {
  const Volume volume = index_volume({7, 6, 5}, [](const Vec3& p) { return std::sin(p.x) + p.y * p.y + p.z * p.x; });
  SiteRequest request = whole(volume);
  request.isovalues = ValueRange{.low = 2.0f, .high = 12.0f};
  const std::vector<Vec3f> points{{0.5f, 0.5f, 0.5f}, {2.5f, 1.5f, 0.5f}, {5.5f, 4.5f, 3.5f}, {1.5f, 2.5f, 2.5f}};
  const Sites sites = make_sites(volume, points, request, {});
  ASSERT_EQ(sites.positions, (std::vector<Vec3f>{points[1], points[3]}));
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const Sites alone = make_sites(volume, {sites.positions[s]}, request, {});
    EXPECT_EQ(sites.normals[s], alone.normals.at(0));
    EXPECT_EQ(sites.isovalues[s], alone.isovalues.at(0));
  }
}

TEST(MakeSites, DropsFlatCellsButNotTheirBorders) {
  const Volume volume = index_volume({7, 4, 4}, [](const Vec3& p) { return p.x < 3.5 ? 0.0 : p.x; });
  // In the flat part, next to it (where central differences already see the slope), on its border, in the slope.
  const Sites sites =
      make_sites(volume, {{1.2f, 1.5f, 1.5f}, {2.5f, 1.5f, 1.5f}, {3.0f, 1.5f, 1.5f}, {3.5f, 1, 1}}, whole(volume), {});
  ASSERT_EQ(sites.size(), 2u);
  EXPECT_EQ(sites.positions[0].x, 3.0f);
  EXPECT_EQ(sites.positions[1].x, 3.5f);
}

TEST(MakeSites, PutsPointsBesideTheBoxOnItsFacesAndDropsNonFiniteOnes) {
  const Volume volume = index_volume({5, 5, 5}, [](const Vec3& p) { return p.x + p.y; });
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Sites sites = make_sites(volume, {{-1e-6f, 2, 4.000001f}, {kNan, 1, 1}, {1, kInfinity, 1}}, whole(volume), {});
  ASSERT_EQ(sites.size(), 1u);
  EXPECT_EQ(sites.positions[0], Vec3f(0, 2, 4));
}

}  // namespace
}  // namespace isolux
