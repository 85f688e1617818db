#include "wide/stencil.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>

namespace isolux::wide {
namespace {

struct Point {
  int shell;  ///< 16 an octave of the squared distance
  std::array<int, 3> step;
  double distance;
};

int shell_of(double distance) {
  if (distance == 0.0) return std::numeric_limits<int>::min();
  return int(std::floor(32.0 * std::log2(distance) + 1e-6));
}

/// Those within a distance, of a box of so many points.
std::vector<Point> points_within(double far, const std::array<double, 3>& steps, const std::array<int, 3>& size) {
  std::array<int, 3> reach{};
  for (std::size_t a = 0; a < 3; ++a) reach[a] = int(std::min(far / steps[a], double(size[a] - 1)));
  std::vector<Point> points;
  for (int k = -reach[2]; k <= reach[2]; ++k) {
    for (int j = -reach[1]; j <= reach[1]; ++j) {
      for (int i = -reach[0]; i <= reach[0]; ++i) {
        const double distance = std::hypot(i * steps[0], j * steps[1], k * steps[2]);
        if (distance <= far) points.push_back({shell_of(distance), {i, j, k}, distance});
      }
    }
  }
  return points;
}

/// As many as a stencil has, or all; sorted.
std::vector<Point> points_around(const std::array<double, 3>& steps, const std::array<int, 3>& size) {
  constexpr double kGrow = 1.25;
  const double farthest = std::hypot(steps[0] * size[0], steps[1] * size[1], steps[2] * size[2]);
  double far = *std::min_element(steps.begin(), steps.end());
  std::vector<Point> points = points_within(far, steps, size);
  while (points.size() < Stencil::kMostMembers && far < farthest) {
    far *= kGrow;
    points = points_within(far, steps, size);
  }
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return std::tie(a.shell, a.distance, a.step[2], a.step[1], a.step[0]) <
           std::tie(b.shell, b.distance, b.step[2], b.step[1], b.step[0]);
  });
  points.resize(std::min(points.size(), Stencil::kMostMembers));
  return points;
}

}  // namespace

Stencil Stencil::of(const std::array<double, 3>& steps, const std::array<int, 3>& size) {
  Stencil stencil;
  int last = 0;
  double distances = 0.0;
  std::size_t begin = 0;
  for (const Point& point : points_around(steps, size)) {
    const auto [i, j, k] = point.step;
    const auto at = std::find_if(stencil.rows.begin(), stencil.rows.end(),
                                 [y = j, z = k](const Row& row) { return row.y == y && row.z == z; });
    const auto row = std::size_t(at - stencil.rows.begin());
    if (at == stencil.rows.end()) stencil.rows.push_back({.y = j, .z = k, .reach = 0});
    stencil.rows[row].reach = std::max(stencil.rows[row].reach, std::abs(i));
    stencil.reach = std::max(stencil.reach, std::abs(i));
    if (stencil.shells.empty() || point.shell != last || stencil.members.size() - begin == kLargestShell) {
      stencil.shells.push_back({});
      begin = stencil.members.size();
      distances = 0.0;
      last = point.shell;
    }
    stencil.members.push_back({.step = point.step,
                               .place = {float(i * steps[0]), float(j * steps[1]), float(k * steps[2])},
                               .row = row,
                               .along = 0});
    distances += point.distance;
    stencil.shells.back() = {.end = stencil.members.size(),
                             .rows = stencil.rows.size(),
                             .distance = float(distances / double(stencil.members.size() - begin))};
  }
  for (Member& member : stencil.members) member.along = std::size_t(member.step[0] + stencil.rows[member.row].reach);
  return stencil;
}

}  // namespace isolux::wide
