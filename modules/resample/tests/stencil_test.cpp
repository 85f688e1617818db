#include "wide/stencil.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace isolux::wide {
namespace {

double away(const std::array<int, 3>& step, const std::array<double, 3>& steps) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 3; ++a) sum += std::pow(step[a] * steps[a], 2.0);
  return std::sqrt(sum);
}

void expect_sound(const Stencil& stencil, const std::array<double, 3>& steps) {
  ASSERT_FALSE(stencil.members.empty());
  EXPECT_EQ(stencil.members[0].step, (std::array{0, 0, 0}));
  EXPECT_LE(stencil.members.size(), Stencil::kMostMembers);
  EXPECT_LE(stencil.rows.size(), Stencil::kMostRows);
  EXPECT_EQ(stencil.shells.back().end, stencil.members.size());
  std::set<std::array<int, 3>> seen;
  std::size_t shell = 0;
  for (std::size_t m = 0; m < stencil.members.size(); ++m) {
    const Stencil::Member& member = stencil.members[m];
    EXPECT_TRUE(seen.insert(member.step).second);
    for (std::size_t a = 0; a < 3; ++a) EXPECT_FLOAT_EQ(member.place[a], float(member.step[a] * steps[a]));
    const Stencil::Row& row = stencil.rows[member.row];
    EXPECT_EQ((std::array{row.y, row.z}), (std::array{member.step[1], member.step[2]}));
    EXPECT_EQ(int(member.along) - row.reach, member.step[0]);
    EXPECT_LE(row.reach, Stencil::kLongestReach);
    if (m == stencil.shells[shell].end) ++shell;
    EXPECT_LT(member.row, stencil.shells[shell].rows);
    EXPECT_NEAR(away(member.step, steps), double(stencil.shells[shell].distance),
                0.025 * double(stencil.shells[shell].distance));
  }
  std::size_t begin = 0;
  for (const Stencil::Shell& one : stencil.shells) {
    EXPECT_LE(one.end - begin, Stencil::kLargestShell);
    begin = one.end;
  }
  EXPECT_TRUE(std::is_sorted(stencil.shells.begin(), stencil.shells.end(),
                             [](const auto& a, const auto& b) { return a.distance < b.distance; }));
}

TEST(Stencil, IsABallOfWholeShells) {
  const Stencil stencil = Stencil::of({1.0, 1.0, 1.0});
  expect_sound(stencil, {1.0, 1.0, 1.0});
  EXPECT_EQ(stencil.members.size(), 515u);
  EXPECT_EQ(stencil.rows.size(), 81u);
  EXPECT_FLOAT_EQ(stencil.shells.back().distance, 5.0f);
  for (const std::size_t whole : {1u, 7u, 19u, 27u, 33u, 57u, 123u, 203u}) {
    EXPECT_TRUE(std::any_of(stencil.shells.begin(), stencil.shells.end(), [&](const Stencil::Shell& shell) {
      return shell.end == whole;
    })) << whole;
  }
}

TEST(Stencil, HoldsTheNearestPoints) {
  for (const std::array<double, 3>& steps :
       {std::array{1.0, 1.0, 3.0}, std::array{2.1, 1.0, 1.0}, std::array{0.8, 1.1, 1.3}, std::array{1.0, 4.0, 1.0}}) {
    const Stencil stencil = Stencil::of(steps);
    expect_sound(stencil, steps);
    std::set<std::array<int, 3>> members;
    for (const Stencil::Member& member : stencil.members) members.insert(member.step);
    const double far = 0.95 * double(stencil.shells.back().distance);
    for (int k = -20; k <= 20; ++k)
      for (int j = -20; j <= 20; ++j)
        for (int i = -20; i <= 20; ++i)
          EXPECT_TRUE(away({i, j, k}, steps) >= far || members.count({i, j, k}) > 0) << i << " " << j << " " << k;
  }
}

TEST(Stencil, HasLimits) {
  for (const std::array<double, 3>& steps :
       {std::array{0.01, 1.0, 1.0}, std::array{100.0, 1.0, 1.0}, std::array{1.0, 1e-3, 1e3}, std::array{1.0, 1e6, 1e6}})
    expect_sound(Stencil::of(steps), steps);
}

}  // namespace
}  // namespace isolux::wide
