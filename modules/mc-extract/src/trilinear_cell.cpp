#include "trilinear_cell.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>

#include "cube.h"

namespace isolux::mc {

TrilinearCell::TrilinearCell(const std::array<double, 8>& corners) : corners_(corners), c_(corners) {
  // The Moebius transform: each coefficient is the corner less all coefficients of its proper subsets.
  for (int axis = 1; axis < 8; axis <<= 1)
    for (int c = 0; c < 8; ++c)
      if ((c & axis) != 0) c_[c] -= c_[c ^ axis];
}

double TrilinearCell::value(const Vec3& p) const {
  return c_[0] + c_[1] * p.x + p.y * (c_[2] + c_[3] * p.x) + p.z * (c_[4] + c_[5] * p.x + p.y * (c_[6] + c_[7] * p.x));
}

Vec3 TrilinearCell::gradient(const Vec3& p) const {
  return {c_[1] + c_[3] * p.y + c_[5] * p.z + c_[7] * p.y * p.z, c_[2] + c_[3] * p.x + c_[6] * p.z + c_[7] * p.x * p.z,
          c_[4] + c_[5] * p.x + c_[6] * p.y + c_[7] * p.x * p.y};
}

int TrilinearCell::joined_faces() const {
  int joined = 0;
  for (int face = 0; face < 6; ++face) {
    const auto& q = kFaceCorners[face];
    const auto inside = [&](int i) { return corners_[q[i]] >= 0.0; };
    if (inside(0) != inside(2) || inside(1) != inside(3) || inside(0) == inside(1)) continue;
    const double even = corners_[q[0]] * corners_[q[2]];
    const double odd = corners_[q[1]] * corners_[q[3]];
    if (inside(0) ? even >= odd : odd >= even) joined |= 1 << face;
  }
  return joined;
}

std::array<int, 8> TrilinearCell::boundary_regions() const {
  std::array<int, 8> region{};
  std::iota(region.begin(), region.end(), 0);
  const auto join = [&](int a, int b) {
    const int from = region[a];
    const int to = region[b];
    std::ranges::replace(region, from, to);
  };
  const auto inside = [&](int c) { return corners_[c] >= 0.0; };
  for (const CubeEdge& edge : kCubeEdges)
    if (inside(edge.low) == inside(edge.high())) join(edge.low, edge.high());
  const int joined = joined_faces();
  for (int face = 0; face < 6; ++face) {
    const auto& q = kFaceCorners[face];
    if (inside(q[0]) != inside(q[2]) || inside(q[1]) != inside(q[3])) continue;
    const bool inner_connected = (joined >> face & 1) != 0;
    if (inside(q[0]) == inner_connected) join(q[0], q[2]);
    if (inside(q[1]) == inner_connected) join(q[1], q[3]);
  }
  return region;
}

int TrilinearCell::climb(Vec3 p, double sign) const {
  int corner = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const bool up = sign * gradient(p)[axis] > 0.0;
    p[axis] = up ? 1.0 : 0.0;
    if (up) corner |= 1 << axis;
  }
  return corner;
}

std::array<std::optional<Vec3>, 2> TrilinearCell::critical_points() const {
  std::array<std::optional<Vec3>, 2> points;
  const double k = c_[7];
  const Vec3 pairs(c_[6], c_[5], c_[3]);  // of vw, uw, uv
  const Vec3 linear(c_[1], c_[2], c_[4]);
  double scale = 0.0;
  for (const double v : c_) scale = std::max(scale, std::fabs(v));
  if (std::fabs(k) > 1e-10 * scale) {
    // Moved to its centre, F = k UVW + a.x U + a.y V + a.z W + const, stationary where VW = -a.x/k and so on.
    const Vec3 centre = -pairs / k;
    const Vec3 a = linear - Vec3(pairs.y * pairs.z, pairs.x * pairs.z, pairs.x * pairs.y) / k;
    const double square = -a.x * a.y * a.z / (k * k * k);
    if (!(square > 0.0)) return points;
    const double t = std::sqrt(square);
    points[0] = centre - t * k / a;
    points[1] = centre + t * k / a;
  } else {
    const double det = 2.0 * pairs.x * pairs.y * pairs.z;
    if (det == 0.0) return points;
    const Mat3 matrix(0.0, pairs.z, pairs.y, pairs.z, 0.0, pairs.x, pairs.y, pairs.x, 0.0);
    points[0] = glm::inverse(matrix) * -linear;
  }
  return points;
}

std::optional<TrilinearCell::Tunnel> TrilinearCell::tunnel_at(const Vec3& saddle) const {
  for (int a = 0; a < 3; ++a)
    if (!(saddle[a] > 0.0 && saddle[a] < 1.0)) return {};
  // The Hessian has a zero diagonal: its eigenvalues add up to nothing, so the one of its own sign is the largest in
  // size and has the sign of the determinant.
  const Vec3 h(c_[6] + c_[7] * saddle.x, c_[5] + c_[7] * saddle.y, c_[3] + c_[7] * saddle.z);
  const double sign = h.x * h.y * h.z > 0.0 ? 1.0 : -1.0;
  if ((value(saddle) >= 0.0) != (sign > 0.0)) return {};
  const Mat3 hessian(0.0, h.z, h.y, h.z, 0.0, h.x, h.y, h.x, 0.0);
  const double size = std::fabs(h.x) + std::fabs(h.y) + std::fabs(h.z);
  if (!(size > 0.0)) return {};
  // Power iteration, with a shift that keeps the two others behind.
  const Mat3 shifted = hessian * (sign / size) + Mat3(0.5);
  Vec3 direction(1.0, 0.9, 0.8);
  for (int i = 0; i < 60; ++i) direction = glm::normalize(shifted * direction);
  double step = 1.0;
  for (int a = 0; a < 3; ++a)
    step = std::min(step, 0.5 * std::min(saddle[a], 1.0 - saddle[a]) / std::max(1e-9, std::fabs(direction[a])));
  // Near enough for the quadratic part to rule the cubic one.
  const double curvature = std::fabs(glm::dot(direction, hessian * direction));
  step = std::min(step, 0.5 * curvature / std::max(std::fabs(c_[7]), 1e-300));
  const int from = climb(saddle - step * direction, sign);
  const int to = climb(saddle + step * direction, sign);
  const std::array<int, 8> region = boundary_regions();
  if (region[from] == region[to]) return {};
  return Tunnel{.from = from, .to = to};
}

std::optional<TrilinearCell::Tunnel> TrilinearCell::tunnel() const {
  for (const std::optional<Vec3>& point : critical_points()) {
    if (!point) continue;
    if (const auto found = tunnel_at(*point)) return found;
  }
  return {};
}

std::optional<std::array<Vec3, 6>> TrilinearCell::hexagon() const {
  // In the plane w the level set is a hyperbola, and two lines u = -C/D, v = -B/D where A D = B C with A = c0 + c4 w,
  // B = c1 + c5 w, C = c2 + c6 w, D = c3 + c7 w.
  const double quadratic = c_[4] * c_[7] - c_[5] * c_[6];
  const double half = 0.5 * (c_[0] * c_[7] + c_[4] * c_[3] - c_[1] * c_[6] - c_[5] * c_[2]);
  const double constant = c_[0] * c_[3] - c_[1] * c_[2];
  const double discriminant = half * half - quadratic * constant;
  if (!(discriminant > 0.0) || quadratic == 0.0) return {};
  const double q = -(half + std::copysign(std::sqrt(discriminant), half));
  const std::array<double, 2> w = {q / quadratic, constant / q};
  std::array<double, 2> u{};
  std::array<double, 2> v{};
  for (int n = 0; n < 2; ++n) {
    const double d = c_[3] + c_[7] * w[n];
    u[n] = -(c_[2] + c_[6] * w[n]) / d;
    v[n] = -(c_[1] + c_[5] * w[n]) / d;
    for (const double x : {u[n], v[n], w[n]})
      if (!(x > 0.0 && x < 1.0)) return {};
  }
  return std::array<Vec3, 6>{Vec3(u[0], v[0], w[0]), Vec3(u[0], v[1], w[0]), Vec3(u[0], v[1], w[1]),
                             Vec3(u[1], v[1], w[1]), Vec3(u[1], v[0], w[1]), Vec3(u[1], v[0], w[0])};
}

}  // namespace isolux::mc
