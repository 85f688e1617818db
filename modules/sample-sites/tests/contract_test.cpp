#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/sample_sites.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "test_volumes.h"

namespace isolux {
namespace {

std::vector<std::string> backend_names() {
  std::vector<std::string> names;
  const auto registry = samplers();
  for (const auto& info : registry.backends())
    if (info.unavailable.empty()) names.push_back(info.name);
  return names;
}

double ball(const Vec3& p) { return -glm::length(p - Vec3(10.0)); }

/// What holds for every backend.
class EverySampler : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static Sites sample(const Volume& volume, std::size_t count,
                                    std::optional<ValueRange> isovalues = std::nullopt,
                                    const isolux::Run& run = isolux::Run{}) {
    const SiteRequest request{.texels = cell_lattice(volume.lattice()), .count = count, .isovalues = isovalues};
    return samplers().create(GetParam())->sample(volume, request, run);
  }
};

TEST_P(EverySampler, SitesLieInTheBoxOnTheirLevelSetsWithUnitNormals) {
  const Volume volume = index_volume({21, 17, 11}, ball);
  const TrilinearField field(volume);
  const Sites sites = sample(volume, 3000);
  EXPECT_GT(sites.size(), 2500u);
  ASSERT_EQ(sites.isovalues.size(), sites.size());
  ASSERT_EQ(sites.normals.size(), sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    for (int a = 0; a < 3; ++a) {
      EXPECT_GE(sites.positions[i][a], 0.0f);
      EXPECT_LE(sites.positions[i][a], float(volume.lattice().size[a] - 1));
    }
    EXPECT_EQ(sites.isovalues[i], float(field.value(Vec3(sites.positions[i]))));
    EXPECT_NEAR(glm::length(sites.normals[i]), 1.0f, 1e-6f);  // rounding of three floats
  }
}

TEST_P(EverySampler, ZeroMeansAboutOneSiteATexel) {
  const Volume volume = index_volume({15, 15, 15}, [](const Vec3& p) { return p.x + 0.5 * p.y - p.z; });
  const double texels = 14.0 * 14.0 * 14.0;
  EXPECT_NEAR(double(sample(volume, 0).size()), texels, 0.05 * texels);  // strata are whole numbers on each axis
}

TEST_P(EverySampler, RangeIsRespected) {
  const Volume volume = index_volume({21, 21, 21}, ball);
  const Sites sites = sample(volume, 2000, ValueRange{.low = -6.0f, .high = -5.0f});
  EXPECT_GT(sites.size(), 200u);
  for (const float h : sites.isovalues) {
    EXPECT_GE(h, -6.0f);
    EXPECT_LE(h, -5.0f);
  }
}

TEST_P(EverySampler, FlatVolumesAndRangesBesideTheValuesGiveNoSites) {
  EXPECT_EQ(sample(index_volume({5, 5, 5}, [](const Vec3&) { return 3.0; }), 100).size(), 0u);
  const Volume volume = index_volume({5, 5, 5}, ball);
  EXPECT_EQ(sample(volume, 100, ValueRange{.low = 1.0f, .high = 2.0f}).size(), 0u);
  EXPECT_EQ(sample(volume, 100, ValueRange{.low = 2.0f, .high = -20.0f}).size(), 0u);
  // Cells meet this range only in a corner, so hardly a candidate is ever inside: it ends all the same.
  EXPECT_LT(sample(volume, 10, ValueRange{.low = 0.0f, .high = 0.0f}).size(), 10u);
}

TEST_P(EverySampler, SameBitsForAnyNumberOfThreads) {
  const Volume volume = index_volume({33, 20, 18}, ball);
  for (const std::optional<ValueRange> range : {std::optional<ValueRange>{}, {{.low = -9.0f, .high = -4.0f}}}) {
    const Sites one = sample(volume, 20000, range, {.seed = 5, .threads = 1});
    for (const int threads : {2, 3}) {
      const Sites many = sample(volume, 20000, range, {.seed = 5, .threads = threads});
      EXPECT_EQ(one.positions, many.positions);
      EXPECT_EQ(one.isovalues, many.isovalues);
      EXPECT_EQ(one.normals, many.normals);
    }
  }
}

TEST_P(EverySampler, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  isolux::Run run;
  run.stop = source.get_token();
  EXPECT_THROW((void)sample(index_volume({5, 5, 5}, ball), 100, std::nullopt, run), Cancelled);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EverySampler, testing::ValuesIn(backend_names()),
                         [](const auto& backend) { return backend.param; });

}  // namespace
}  // namespace isolux
