// How the texels' sites are cut into parts of the isovalues.
#include "isovalue_parts.h"

#include <gtest/gtest.h>
#include <isolux/sample_sites/site_sampler.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isolux::test {
namespace {

SiteRequest request_of(const Volume& volume) { return {.texels = cell_lattice(volume.lattice())}; }

/// Sites of each part; every site must be in just one.
std::vector<std::size_t> sites_of(const Volume& volume, const std::vector<ValueRange>& parts) {
  const Sites all = samplers().create("texels")->sample(volume, request_of(volume), {});
  std::vector<std::size_t> counts(parts.size(), 0);
  for (const float h : all.isovalues) {
    std::size_t holders = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const bool holds = h >= parts[p].low && h <= parts[p].high;
      counts[p] += std::size_t(holds);
      holders += std::size_t(holds);
    }
    EXPECT_EQ(holders, 1U) << h;
  }
  return counts;
}

TEST(IsovalueParts, HoldEqualSharesWhereIsovaluesDiffer) {
  const Volume volume = read_volume("gen:noise:33");
  const auto parts = isovalue_parts(volume, request_of(volume), 8, {});
  ASSERT_EQ(parts.size(), 8U);
  // Shares are found from 32768 texels drawn at random, of which a part has 4096: known to 2 %.
  for (const std::size_t sites : sites_of(volume, parts))
    EXPECT_NEAR(double(sites), 32768.0 / 8.0, 0.08 * 32768.0 / 8.0);
}

// Whole numbers, half of them the same one: it cannot be parted, and must not take others with it.
TEST(IsovalueParts, EndBeforeAnIsovalueThatManyHave) {
  Volume volume = read_volume("gen:noise:33");
  for (float& value : volume.values.values()) value = value > 0.45f ? 5.0f : std::floor(value * 10.0f);
  const auto parts = isovalue_parts(volume, request_of(volume), 8, {});
  const auto sites = sites_of(volume, parts);
  std::size_t all = 0;
  for (const std::size_t count : sites) all += count;
  std::size_t largest_alone = 0;
  const Sites every = samplers().create("texels")->sample(volume, request_of(volume), {});
  std::vector<float> isovalues = every.isovalues;
  std::sort(isovalues.begin(), isovalues.end());
  for (auto begin = isovalues.begin(); begin != isovalues.end();) {
    const auto end = std::upper_bound(begin, isovalues.end(), *begin);
    largest_alone = std::max(largest_alone, std::size_t(end - begin));
    begin = end;
  }
  const double share = double(all) / 8.0;
  for (const std::size_t count : sites) {
    EXPECT_LT(double(count), 1.1 * (double(largest_alone) + 0.5 * share));
    EXPECT_GT(double(count), 0.4 * share) << "nets want sites that lie densely";
  }
}

TEST(IsovalueParts, AreOneWhereSitesAreFew) {
  const Volume volume = read_volume("gen:gyroid:33");
  const auto parts = isovalue_parts(volume, request_of(volume), 0, {});
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].high, std::numeric_limits<float>::infinity());
  EXPECT_GT(isovalue_parts(read_volume("gen:gyroid:65"), request_of(read_volume("gen:gyroid:65")), 0, {}).size(), 2U);
}

}  // namespace
}  // namespace isolux::test
