#include "ray_budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace isolux {
namespace {

/// Levels of variance / rays: eight to a factor of two, the lowest 2^-80.
constexpr int kLevels = 640;
constexpr int kLevelsAFactor = 8;
/// A doubling divides the variance by 2^1.5 and doubles the rays.
constexpr int kLevelsADoubling = 20;
constexpr std::uint32_t kMostRays = 1u << 20;

/// Sites of one level together.
struct Level {
  double variance = 0.0;
  double rays = 0.0;
};
using Levels = std::array<Level, kLevels>;

double smoothed(std::span<const float> variances, std::size_t site) {
  const auto at = [&](std::size_t i) { return variances[i] < kUnknownVariance ? double(variances[i]) : 0.0; };
  const double before = site > 0 ? at(site - 1) : at(site);
  const double after = site + 1 < variances.size() ? at(site + 1) : at(site);
  return 0.25 * (before + after) + 0.5 * at(site);
}

/// -1 for sites that need no rays: without a normal, or as many as there can be.
int level_of(double variance, std::uint32_t rays, float own) {
  if (own >= kUnknownVariance || rays >= kMostRays || !(variance > 0.0)) return -1;
  const double level = std::log2(variance / double(rays)) * kLevelsAFactor + kLevels;
  return std::clamp(int(level), 0, kLevels - 1);
}

struct Forecast {
  double variance = 0.0;
  double rays = 0.0;  ///< more than now
};

Forecast forecast(const Levels& levels, int limit) {
  Forecast result;
  for (int b = 0; b < kLevels; ++b) {
    const Level& level = levels[std::size_t(b)];
    const int doublings = b > limit ? (b - limit + kLevelsADoubling - 1) / kLevelsADoubling : 0;
    result.variance += level.variance * std::exp2(-1.5 * doublings);
    result.rays += level.rays * (std::exp2(doublings) - 1.0);
  }
  return result;
}

}  // namespace

std::vector<std::uint32_t> sites_to_double(std::span<const float> variances, std::span<const std::uint32_t> rays,
                                           const RayBudget& budget) {
  Levels levels{};
  std::size_t known = 0;
  std::vector<std::int16_t> level(variances.size());
  for (std::size_t i = 0; i < variances.size(); ++i) {
    const double variance = smoothed(variances, i);
    level[i] = std::int16_t(level_of(variance, rays[i], variances[i]));
    known += std::size_t(variances[i] < kUnknownVariance);
    if (level[i] < 0) continue;
    levels[std::size_t(level[i])].variance += variance;
    levels[std::size_t(level[i])].rays += double(rays[i]);
  }
  int limit = kLevels - 1;
  while (limit > 0 && forecast(levels, limit).variance > budget.mean_variance * double(known)) --limit;
  while (limit < kLevels - 1 && forecast(levels, limit).rays > budget.rays) ++limit;
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < level.size(); ++i)
    if (level[i] > limit) chosen.push_back(std::uint32_t(i));
  return chosen;
}

}  // namespace isolux
