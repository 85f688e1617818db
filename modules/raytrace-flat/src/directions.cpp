#include "directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isolux {

Frame frame_about(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {.x = {1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, .y = {b, sign + n.y * n.y * a, -n.y}, .z = n};
}

DiscPoint disc_point(double u, double v) {
  const double a = 2.0 * u - 1.0;
  const double b = 2.0 * v - 1.0;
  if (a == 0.0 && b == 0.0) return {0.0, 0.0};
  constexpr double kEighth = std::numbers::pi / 4.0;
  const bool wide = std::fabs(a) > std::fabs(b);
  const double radius = wide ? a : b;
  const double angle = wide ? kEighth * (b / a) : 2.0 * kEighth - kEighth * (a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

Vec3 cosine_direction(double u, double v) {
  const DiscPoint p = disc_point(u, v);
  return {p.x, p.y, std::sqrt(std::max(0.0, 1.0 - p.x * p.x - p.y * p.y))};
}

Vec3 cone_direction(double u, double v, double one_minus_cosine) {
  const DiscPoint p = disc_point(u, v);
  // On the disc the square of the radius is uniform in [0, 1], as 1 - cos is in the cone.
  const double sunk = (p.x * p.x + p.y * p.y) * one_minus_cosine;
  const double stretch = std::sqrt(one_minus_cosine * (2.0 - sunk));
  return {p.x * stretch, p.y * stretch, 1.0 - sunk};
}

}  // namespace isolux
