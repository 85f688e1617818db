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

constexpr std::array<int, 3> kWide{200, 200, 200};

void expect_sound(const Stencil& stencil, const std::array<double, 3>& steps) {
  ASSERT_FALSE(stencil.members.empty());
  EXPECT_EQ(stencil.members[0].step, (std::array{0, 0, 0}));
  EXPECT_LE(stencil.members.size(), Stencil::kMostMembers);
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
    EXPECT_LE(row.reach, stencil.reach);
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
  const Stencil stencil = Stencil::of({1.0, 1.0, 1.0}, kWide);
  expect_sound(stencil, {1.0, 1.0, 1.0});
  EXPECT_EQ(stencil.members.size(), 2109u);
  EXPECT_EQ(stencil.rows.size(), 197u);
  EXPECT_NEAR(stencil.shells.back().distance, 8.0f, 0.1f);
  for (const std::size_t whole : {1u, 7u, 19u, 27u, 33u, 57u, 123u, 203u, 515u}) {
    EXPECT_TRUE(std::any_of(stencil.shells.begin(), stencil.shells.end(), [&](const Stencil::Shell& shell) {
      return shell.end == whole;
    })) << whole;
  }
}

TEST(Stencil, HoldsTheNearestPoints) {
  for (const std::array<double, 3>& steps :
       {std::array{1.0, 1.0, 3.0}, std::array{2.1, 1.0, 1.0}, std::array{0.8, 1.1, 1.3}, std::array{1.0, 4.0, 1.0}}) {
    const Stencil stencil = Stencil::of(steps, kWide);
    expect_sound(stencil, steps);
    std::set<std::array<int, 3>> members;
    for (const Stencil::Member& member : stencil.members) members.insert(member.step);
    const double far = 0.95 * double(stencil.shells.back().distance);
    for (int k = -30; k <= 30; ++k)
      for (int j = -30; j <= 30; ++j)
        for (int i = -30; i <= 30; ++i)
          EXPECT_TRUE(away({i, j, k}, steps) >= far || members.count({i, j, k}) > 0) << i << " " << j << " " << k;
  }
}

TEST(Stencil, KnowsItsBox) {
  EXPECT_EQ(Stencil::of({1.0, 1.0, 1.0}, {1, 1, 1}).members.size(), 1u);
  const Stencil line = Stencil::of({1.0, 1.0, 1.0}, {1, 1, 300});
  expect_sound(line, {1.0, 1.0, 1.0});
  EXPECT_EQ(line.members.size(), 599u);
  const Stencil plane = Stencil::of({1.0, 2.0, 1.0}, {100, 1, 100});
  expect_sound(plane, {1.0, 2.0, 1.0});
  EXPECT_EQ(plane.members.size(), Stencil::kMostMembers);
}

TEST(Stencil, TakesAnySteps) {
  for (const std::array<double, 3>& steps :
       {std::array{0.01, 1.0, 1.0}, std::array{100.0, 1.0, 1.0}, std::array{1.0, 1e-3, 1e3}, std::array{1.0, 1e6, 1e6},
        std::array{1.0, 1.0, 1e10}, std::array{1e-20, 1e-20, 1.0}, std::array{1.0, 1e12, 1e12}})
    expect_sound(Stencil::of(steps, kWide), steps);
}

}  // namespace
}  // namespace isolux::wide
