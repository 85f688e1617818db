#include "cell_cubic.h"

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

// Exact at both ends and never of a sign that neither end has, whatever their sizes: a + t (b - a) is not.
double mix(double a, double b, double t) { return (1.0 - t) * a + t * b; }

double slope_at(const std::array<double, 4>& b, double s) {
  return 3.0 * mix(mix(b[1] - b[0], b[2] - b[1], s), mix(b[2] - b[1], b[3] - b[2], s), s);
}

// The one root in [low, high], where the cubic is negative at low, at least zero at high and has no other root between:
// Newton's steps while they stay in the shrinking bracket and shrink it fast enough, halving where they do not.
double bracketed_root(const std::array<double, 4>& b, double low, double high, double value_low, double value_high) {
  if (value_high <= 0.0) return high;
  double s = low + (high - low) * (value_low / (value_low - value_high));
  double previous_step = high - low;
  for (int i = 0; i < 100; ++i) {
    if (!(s > low && s < high)) s = 0.5 * (low + high);
    const double value = cubic_at(b, s);
    if (value == 0.0) return s;
    (value < 0.0 ? low : high) = s;
    const double slope = slope_at(b, s);
    double next = s - value / slope;
    if (!(next > low && next < high && std::fabs(next - s) < 0.5 * previous_step)) next = 0.5 * (low + high);
    previous_step = std::fabs(next - s);
    if (next == s || high - low <= 0x1p-52 * high) return next;
    if (previous_step <= 0x1p-53 * s) return next;
    s = next;
  }
  return s;
}

// Place of the cubic's inner maximum in (0, 1), or a value outside.
double inner_maximum(const std::array<double, 4>& b) {
  const double d0 = b[1] - b[0];
  const double d1 = b[2] - b[1];
  const double d2 = b[3] - b[2];
  // Derivative / 3 = d0 + p s + q s^2; its root with a falling sign, by the form that does not cancel.
  const double p = 2.0 * (d1 - d0);
  const double q = d0 - 2.0 * d1 + d2;
  const double discriminant = d1 * d1 - d0 * d2;
  if (!(discriminant > 0.0)) return -1.0;
  const double root = 2.0 * std::sqrt(discriminant);
  return p < 0.0 ? 2.0 * d0 / (root - p) : -(p + root) / (2.0 * q);
}

}  // namespace

std::array<double, 4> segment_cubic(const CellCorners& v, const std::array<double, 3>& a,
                                    const std::array<double, 3>& z) {
  const double ax[4] = {mix(v[0], v[1], a[0]), mix(v[2], v[3], a[0]), mix(v[4], v[5], a[0]), mix(v[6], v[7], a[0])};
  const double zx[4] = {mix(v[0], v[1], z[0]), mix(v[2], v[3], z[0]), mix(v[4], v[5], z[0]), mix(v[6], v[7], z[0])};
  const double aa[2] = {mix(ax[0], ax[1], a[1]), mix(ax[2], ax[3], a[1])};
  const double az[2] = {mix(ax[0], ax[1], z[1]), mix(ax[2], ax[3], z[1])};
  const double za[2] = {mix(zx[0], zx[1], a[1]), mix(zx[2], zx[3], a[1])};
  const double zz[2] = {mix(zx[0], zx[1], z[1]), mix(zx[2], zx[3], z[1])};
  constexpr double kThird = 1.0 / 3.0;
  return {
      mix(aa[0], aa[1], a[2]), (mix(aa[0], aa[1], z[2]) + mix(az[0], az[1], a[2]) + mix(za[0], za[1], a[2])) * kThird,
      (mix(az[0], az[1], z[2]) + mix(za[0], za[1], z[2]) + mix(zz[0], zz[1], a[2])) * kThird, mix(zz[0], zz[1], z[2])};
}

double cell_value(const CellCorners& v, const std::array<double, 3>& p) {
  const double low = mix(mix(v[0], v[1], p[0]), mix(v[2], v[3], p[0]), p[1]);
  const double high = mix(mix(v[4], v[5], p[0]), mix(v[6], v[7], p[0]), p[1]);
  return mix(low, high, p[2]);
}

double cubic_at(const std::array<double, 4>& b, double s) {
  const double m = mix(b[1], b[2], s);
  return mix(mix(mix(b[0], b[1], s), m, s), mix(m, mix(b[2], b[3], s), s), s);
}

std::optional<double> first_root(const std::array<double, 4>& b, RootWish wish) {
  if (b[1] < 0.0 && b[2] < 0.0) {
    if (b[3] < 0.0) return std::nullopt;
    if (wish == RootWish::kExists) return 1.0;
    // All but the last coefficient negative: one change of sign, one root.
    return bracketed_root(b, 0.0, 1.0, b[0], b[3]);
  }
  if (wish == RootWish::kExists && b[3] >= 0.0) return 1.0;
  // Negative at 0: the first root lies before the inner maximum if that is not negative, else only a cubic that ends
  // above zero has one, behind the inner minimum and alone.
  const double top = inner_maximum(b);
  if (top > 0.0 && top < 1.0) {
    const double value = cubic_at(b, top);
    if (value >= 0.0) return wish == RootWish::kExists ? top : bracketed_root(b, 0.0, top, b[0], value);
    if (b[3] < 0.0) return std::nullopt;
    return bracketed_root(b, top, 1.0, value, b[3]);
  }
  if (b[3] < 0.0) return std::nullopt;
  return bracketed_root(b, 0.0, 1.0, b[0], b[3]);
}

DeflatedRoot deflated_root(const std::array<double, 4>& b) {
  using Kind = DeflatedRoot::Kind;
  // cubic / s as a quadratic with Bernstein coefficients c0, c1, c2. The first is the slope at the start.
  const double c0 = 3.0 * (b[1] - b[0]);
  const double c1 = 1.5 * b[2];
  const double c2 = b[3];
  if (c0 > 0.0) return {.kind = Kind::kBlocked};
  if (c0 < 0.0) {
    if (c2 < 0.0 && (c1 <= 0.0 || c1 * c1 < c0 * c2)) return {.kind = Kind::kMiss};
    // Bernstein's quadratic in r = s/(1 - s) is c0 + 2 c1 r + c2 r^2; of the two forms of its first positive root the
    // one that adds what has one sign.
    const double root = std::sqrt(std::max(0.0, c1 * c1 - c0 * c2));
    const double s = c1 >= 0.0 ? -c0 / (c1 + root - c0) : (root - c1) / (root - c1 + c2);
    return {.kind = Kind::kHit, .s = std::min(s, 1.0)};
  }
  // Tangent at the start: the next factor decides, 2 c1 (1 - s) + c2 s.
  if (c1 > 0.0) return {.kind = Kind::kBlocked};
  if (c1 < 0.0) {
    if (c2 < 0.0) return {.kind = Kind::kMiss};
    return {.kind = Kind::kHit, .s = 2.0 * c1 / (2.0 * c1 - c2)};
  }
  if (c2 > 0.0) return {.kind = Kind::kBlocked};
  return {.kind = c2 < 0.0 ? Kind::kMiss : Kind::kFlat};
}

}  // namespace isolux
