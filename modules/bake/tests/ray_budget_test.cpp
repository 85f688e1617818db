// Which sites get more rays.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "ray_budget.h"

namespace isolux::test {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::max();

/// The first half of the sites is a hundred times as uncertain as the second.
std::vector<float> two_halves(std::size_t count) {
  std::vector<float> variances(count, 1e-5f);
  std::fill_n(variances.begin(), count / 2, 1e-3f);
  return variances;
}

TEST(RayBudget, GivesRaysWhereTheVarianceIs) {
  const auto variances = two_halves(1000);
  const std::vector<std::uint32_t> rays(1000, 16);
  // The mean is 5.05e-4; half of it is reached by doubling the first half alone, which leaves .35 of its variance.
  const auto sites = sites_to_double(variances, rays, {.mean_variance = 2.5e-4});
  // Where the halves meet a site is judged together with its neighbours.
  EXPECT_NEAR(double(sites.size()), 500.0, 1.0);
  EXPECT_EQ(sites.front(), 0u);
}

TEST(RayBudget, GivesEverySiteRaysIfTheErrorWantedIsSmall) {
  const auto sites = sites_to_double(two_halves(100), std::vector<std::uint32_t>(100, 16), {.mean_variance = 1e-9});
  EXPECT_EQ(sites.size(), 100u);
}

TEST(RayBudget, GivesNoneWhereTheErrorIsReached) {
  EXPECT_TRUE(sites_to_double(two_halves(100), std::vector<std::uint32_t>(100, 16), {.mean_variance = 1.0}).empty());
}

TEST(RayBudget, SpendsNoMoreThanTheRaysAllowed) {
  const auto variances = two_halves(1000);
  std::vector<std::uint32_t> rays(1000, 16);
  std::iota(rays.begin() + 500, rays.end(), 16u);
  for (const double allowed : {0.0, 4000.0, 9000.0, 1e5}) {
    double spent = 0.0;
    for (const auto site : sites_to_double(variances, rays, {.mean_variance = 0.0, .rays = allowed}))
      spent += double(rays[site]);
    EXPECT_LE(spent, allowed);
  }
}

TEST(RayBudget, LeavesSitesWithoutANormalAlone) {
  std::vector<float> variances(10, 1e-3f);
  variances[4] = kUnknown;
  for (const auto site : sites_to_double(variances, std::vector<std::uint32_t>(10, 16), {.mean_variance = 1e-9}))
    EXPECT_NE(site, 4u);
}

}  // namespace
}  // namespace isolux::test
