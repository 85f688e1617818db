// How variances are told from probes, whose light is found twice.
#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "wide/calibrate_variance.h"

namespace isolux::test {
namespace {

constexpr std::size_t kSites = 4000;
constexpr std::uint32_t kRaysOfAll = 16;
/// Half of the sites differ by this; of the other half the first result is always 0, the second this once in eight.
constexpr float kStep = 0.25f;

struct Results {
  SampleSet first;
  SampleSet again;
  std::vector<std::size_t> probes;
  std::vector<std::uint32_t> rays;
};

Results with_lucky_half(std::size_t sites = kSites) {
  Results results{.first = {}, .again = {}, .probes = {}, .rays = std::vector<std::uint32_t>(sites, kRaysOfAll)};
  results.first.channels = results.again.channels = 1;
  RandomStream random(1, 2, 3);
  for (std::size_t site = 0; site < sites; ++site) {
    const bool lucky = site % 2 == 0;
    results.first.radiance.push_back(lucky || random.uniform_float() < 0.5f ? 0.0f : kStep);
    results.first.variance.push_back(lucky ? 0.0f : 1.0f);
    results.again.radiance.push_back(random.uniform_float() < (lucky ? 0.125f : 0.5f) ? kStep : 0.0f);
  }
  results.probes.resize(sites);
  std::iota(results.probes.begin(), results.probes.end(), std::size_t(0));
  return results;
}

/// Half the mean squared difference of the two results.
double shown(const Results& results, std::size_t first, std::size_t step) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = first; i < kSites; i += step, ++count)
    sum += 0.5 * std::pow(double(results.first.radiance[i]) - double(results.again.radiance[i]), 2.0);
  return sum / double(count);
}

TEST(CalibrateVariance, OfChosenSitesCountsThoseWhoseRaysAgree) {
  Results results = with_lucky_half();
  wide::calibrate_variance_of_chosen(results.first, results.probes, results.again, results.rays, {});
  EXPECT_NEAR(results.first.variance[0], shown(results, 0, 2), 1e-8);
  EXPECT_NEAR(results.first.variance[1], shown(results, 1, 2), 0.01 * shown(results, 1, 2));
  const double mean = std::accumulate(results.first.variance.begin(), results.first.variance.end(), 0.0) / kSites;
  EXPECT_NEAR(mean, shown(results, 0, 1), 0.01 * mean);
}

TEST(CalibrateVariance, OfOtherNumbersOfRaysIsForetold) {
  Results results = with_lucky_half();
  results.rays[2] = 4 * kRaysOfAll;  // alone: its one probe does not tell
  results.again.radiance[2] = 0.0f;
  wide::calibrate_variance_of_chosen(results.first, results.probes, results.again, results.rays, {});
  EXPECT_NEAR(results.first.variance[2], results.first.variance[0] / 8.0f, 0.01f * results.first.variance[0]);
}

TEST(CalibrateVariance, LeavesAloneWhatFewProbesWouldHaveToTell) {
  Results results = with_lucky_half();
  results.probes = {0, 1, 3, 5, 7, 9};
  wide::calibrate_variance_of_chosen(results.first, results.probes, results.again, results.rays, {});
  EXPECT_EQ(results.first.variance[0], 0.0f);
  EXPECT_GT(results.first.variance[1], 0.0f);
}

TEST(CalibrateVariance, OfUnknownVariancesIsNotTold) {
  for (const bool are_chosen : {false, true}) {
    Results results = with_lucky_half();
    results.first.variance[1] = std::numeric_limits<float>::max();
    if (are_chosen)
      wide::calibrate_variance_of_chosen(results.first, results.probes, results.again, results.rays, {});
    else
      wide::calibrate_variance(results.first, results.probes, results.again, results.rays);
    EXPECT_EQ(results.first.variance[3], 1.0f);
  }
}

TEST(CalibrateVariance, OfChosenSitesIsTheSameForAnyNumberOfThreads) {
  const auto calibrated = [](int threads) {
    Results results = with_lucky_half(300000);
    RandomStream random(4, 5, 6);
    for (std::size_t site = 0; site < results.rays.size(); ++site) {
      results.rays[site] <<= std::uint32_t(site % 3);
      results.first.variance[site] += 0.1f * random.uniform_float();
    }
    wide::calibrate_variance_of_chosen(results.first, results.probes, results.again, results.rays,
                                       {.threads = threads});
    return results.first.variance;
  };
  EXPECT_EQ(calibrated(1), calibrated(4));
}

TEST(CalibrateVariance, AddsUpToWhatProbesShow) {
  Results results = with_lucky_half();
  wide::calibrate_variance(results.first, results.probes, results.again);
  const double mean = std::accumulate(results.first.variance.begin(), results.first.variance.end(), 0.0) / kSites;
  EXPECT_NEAR(mean, shown(results, 0, 1), 0.05 * mean);  // four more probes are thought to say .3
}

}  // namespace
}  // namespace isolux::test
