// Pockets of level sets, told by the lowest way out of the box.
#include "pass_levels.h"

#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <queue>
#include <utility>
#include <vector>

namespace isolux {
namespace {

template <class Value>
Volume volume_of(int n, const Value& value) {
  Volume volume{.values = Grid<float>({.size = Index3(n), .frame = {}}), .name = "made"};
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) volume.values(i, j, k) = float(value(Vec3(i, j, k)));
  return volume;
}

TEST(PassLevels, TellClosedSpheresFromThoseThatTheBoxCuts) {
  constexpr int kSize = 17;
  const auto radius = [](const Vec3& at) { return glm::length(at - 8.0); };
  for (const bool is_lower : {true, false}) {
    const Volume volume = volume_of(kSize, [&](const Vec3& at) { return is_lower ? radius(at) : -radius(at); });
    const PassLevels levels(volume, is_lower ? OuterSide::kLower : OuterSide::kHigher, {});
    const PassLevels from_outside(volume, is_lower ? OuterSide::kHigher : OuterSide::kLower, {});
    const TrilinearField field(volume);
    for (double r = 0.4; r < 11.0; r += 0.3) {
      const Vec3 at = Vec3(8.0) + r * glm::normalize(Vec3(1.0, 0.9, 1.1));
      const auto isovalue = float(field.value(at));
      EXPECT_EQ(levels.is_closed(Vec3f(at), isovalue), std::fabs(isovalue) <= 8.0f) << r;
      EXPECT_FALSE(from_outside.is_closed(Vec3f(at), isovalue)) << r;
    }
  }
}

// All around the hollow there is nothing but the highest value.
TEST(PassLevels, TellPocketsOfTheHighestValue) {
  const Volume volume = volume_of(17, [](const Vec3& at) { return std::min(glm::length(at - 8.0), 5.0); });
  const PassLevels levels(volume, OuterSide::kLower, {});
  EXPECT_TRUE(levels.is_closed(Vec3f(8.0f, 8.0f, 12.9f), 5.0f));
}

TEST(PassLevels, FindNoPocketWhereAllIsTheSame) {
  const Volume volume = volume_of(4, [](const Vec3&) { return 3.0; });
  EXPECT_FALSE(PassLevels(volume, OuterSide::kLower, {}).is_closed(Vec3f(1.5f), 3.0f));
}

/// The lowest ways out of a finer grid's points, along its edges.
std::vector<double> fine_levels(const TrilinearField& field, int size, double step) {
  const auto number = [&](const Index3& at) {
    return (std::size_t(at.z) * std::size_t(size) + std::size_t(at.y)) * std::size_t(size) + std::size_t(at.x);
  };
  std::vector<double> levels(std::size_t(size) * std::size_t(size) * std::size_t(size), 1e30);
  using Place = std::pair<double, std::size_t>;
  std::priority_queue<Place, std::vector<Place>, std::greater<>> queue;
  const auto reach = [&](const Index3& at, double level) {
    level = std::max(level, field.value(step * Vec3(at)));
    if (level >= levels[number(at)]) return;
    levels[number(at)] = level;
    queue.emplace(level, number(at));
  };
  for (int k = 0; k < size; ++k)
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i)
        if (std::min({i, j, k}) == 0 || std::max({i, j, k}) == size - 1) reach({i, j, k}, -1e30);
  while (!queue.empty()) {
    const auto [level, place] = queue.top();
    queue.pop();
    if (level > levels[place]) continue;
    const auto n = std::size_t(size);
    const Index3 at(int(place % n), int(place / n % n), int(place / (n * n)));
    for (int a = 0; a < 3; ++a)
      for (const int to : {-1, 1}) {
        Index3 next = at;
        next[a] += to;
        if (next[a] >= 0 && next[a] < size) reach(next, level);
      }
  }
  return levels;
}

// Noise has every way through saddles that a cell can have. Between the points of the finer grid there are lower ways,
// and slices miss a little of some tunnel within a cell: levels between which the two disagree must be few.
TEST(PassLevels, AgreeWithAFinerGridOnNoise) {
  constexpr int kSize = 6;
  constexpr int kFiner = 12;
  std::size_t closed = 0;
  std::size_t told = 0;
  std::size_t wrong = 0;
  std::size_t places = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    RandomStream random(seed, 3);
    const Volume volume = volume_of(kSize, [&](const Vec3&) { return random.uniform_double(); });
    const TrilinearField field(volume);
    const PassLevels levels(volume, OuterSide::kLower, {});
    const int size = (kSize - 1) * kFiner + 1;
    const std::vector<double> fine = fine_levels(field, size, 1.0 / kFiner);
    for (std::size_t place = 0; place < fine.size(); ++place) {
      const auto n = std::size_t(size);
      const Vec3 at = Vec3(double(place % n), double(place / n % n), double(place / (n * n))) / double(kFiner);
      const double value = field.value(at);
      // A level set a little above a point of the finer grid, whose outer side that point is on.
      const bool is_closed = fine[place] > value + 0.002;
      const bool is_said = levels.is_closed(Vec3f(at), float(value + 0.001));
      ++places;
      closed += is_closed ? 1 : 0;
      told += is_closed && is_said ? 1 : 0;
      wrong += is_said && !is_closed ? 1 : 0;
    }
  }
  EXPECT_GT(closed, 10000u);
  // A corner that is let out stands for all of its cell, where it may be another region's.
  EXPECT_GT(double(told), 0.4 * double(closed));
  EXPECT_LT(double(wrong), 0.01 * double(closed));
}

}  // namespace
}  // namespace isolux
