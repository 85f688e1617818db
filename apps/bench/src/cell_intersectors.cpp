#include "cell_intersectors.h"

#include <cell_cubic.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace isolux::bench {
namespace {

/// f along the way as a polynomial: c[0] + c[1] s + c[2] s^2 + c[3] s^3, by the products of Parker et al. 1998.
template <class Real>
std::array<Real, 4> power_cubic(const CellProblem& problem) {
  std::array<Real, 4> c{};
  for (unsigned q = 0; q < 8; ++q) {
    std::array<Real, 4> product{Real(problem.corners[q]), 0, 0, 0};
    for (unsigned a = 0; a < 3; ++a) {
      const Real start = Real(problem.enter[a]);
      const Real step = Real(problem.leave[a]) - start;
      const bool upper = (q >> a & 1u) != 0;
      const Real at0 = upper ? start : Real(1) - start;
      const Real at1 = upper ? step : -step;
      for (unsigned d = 3; d > 0; --d) product[d] = product[d] * at0 + product[d - 1] * at1;
      product[0] *= at0;
    }
    for (unsigned d = 0; d < 4; ++d) c[d] += product[d];
  }
  return c;
}

template <class Real>
Real at(const std::array<Real, 4>& c, Real s) {
  return ((c[3] * s + c[2]) * s + c[1]) * s + c[0];
}

template <class Real>
CellRoot smallest_in_unit(std::array<Real, 3> roots, int count) {
  Real best = Real(2);
  for (int i = 0; i < count; ++i) {
    if (roots[unsigned(i)] >= 0 && roots[unsigned(i)] <= 1) best = std::min(best, roots[unsigned(i)]);
  }
  if (best > 1) return std::nullopt;
  return double(best);
}

/// The closed form (Schwarze 1990, "Cubic and quartic roots", Graphics Gems), as Parker, Shirley, Livnat, Hansen &
/// Sloan 1998, "Interactive ray tracing for isosurface rendering", use it. As in Schwarze's program a coefficient below
/// kZero, here of the largest one, counts as zero, and the polynomial as one of lower degree.
template <class Real>
CellRoot parker(const CellProblem& problem) {
  constexpr Real kZero = sizeof(Real) == sizeof(double) ? Real(1e-9) : Real(1e-5);
  std::array<Real, 4> c = power_cubic<Real>(problem);
  Real size = 0;
  for (const Real v : c) size = std::max(size, std::fabs(v));
  if (!(size > 0)) return std::nullopt;
  for (Real& v : c) v /= size;
  if (std::fabs(c[3]) < kZero) {
    if (std::fabs(c[2]) < kZero)
      return std::fabs(c[1]) < kZero ? CellRoot() : smallest_in_unit<Real>({-c[0] / c[1]}, 1);
    const Real p = c[1] / (2 * c[2]);
    const Real d = p * p - c[0] / c[2];
    if (!(d >= 0)) return std::nullopt;
    return smallest_in_unit<Real>({-p - std::sqrt(d), -p + std::sqrt(d), 0}, 2);
  }
  const Real a = c[2] / c[3];
  const Real b = c[1] / c[3];
  const Real e = c[0] / c[3];
  const Real p = (b - a * a / 3) / 3;
  const Real q = (a * a * a * 2 / 27 - a * b / 3 + e) / 2;
  const Real d = q * q + p * p * p;
  const Real shift = a / 3;
  if (d > 0) {
    const Real root = std::sqrt(d);
    return smallest_in_unit<Real>({std::cbrt(root - q) - std::cbrt(root + q) - shift, 0, 0}, 1);
  }
  if (d == 0) {
    const Real u = std::cbrt(-q);
    return smallest_in_unit<Real>({2 * u - shift, -u - shift, 0}, 2);
  }
  const Real phi = std::acos(std::clamp(-q / std::sqrt(-p * p * p), Real(-1), Real(1))) / 3;
  const Real t = 2 * std::sqrt(-p);
  const Real third = std::numbers::pi_v<Real> / 3;
  return smallest_in_unit<Real>(
      {t * std::cos(phi) - shift, -t * std::cos(phi + third) - shift, -t * std::cos(phi - third) - shift}, 3);
}

/// The real roots of c[1] + 2 c[2] s + 3 c[3] s^2 in (0, 1), rising, without subtracting near equals; how many.
template <class Real>
int extrema(const std::array<Real, 4>& c, std::array<Real, 2>& places) {
  const Real a = 3 * c[3];
  const Real b = 2 * c[2];
  const Real d = b * b - 4 * a * c[1];
  if (!(d > 0)) return 0;
  const Real q = -(b + std::copysign(std::sqrt(d), b)) / 2;
  int count = 0;
  for (const Real s : {q / a, c[1] / q}) {
    if (s > 0 && s < 1) places[unsigned(count++)] = s;  // false for the infinite one of a straight line
  }
  if (count == 2 && places[0] > places[1]) std::swap(places[0], places[1]);
  return count;
}

constexpr int kInterpolations = 3;

/// Linear interpolation, repeated in the half that keeps the change of sign: f(t0) = f0 and f(t1) = f1 differ in it.
template <class Real, class Function>
CellRoot interpolate(const Function& f, Real t0, Real t1, Real f0, Real f1) {
  for (int i = 0; i < kInterpolations; ++i) {
    const Real t = t0 + (t1 - t0) * (-f0 / (f1 - f0));
    const Real value = f(t);
    if ((value < 0) == (f0 < 0)) {
      t0 = t;
      f0 = value;
    } else {
      t1 = t;
      f1 = value;
    }
  }
  return double(t0 + (t1 - t0) * (-f0 / (f1 - f0)));
}

/// Isolation at the roots of the derivative, then repeated linear interpolation: Marmitt, Kleer, Wald, Friedrich &
/// Slusallek 2004, "Fast and accurate ray-voxel intersection techniques for iso-surface ray tracing", algorithm 1.
template <class Real>
CellRoot marmitt(const CellProblem& problem) {
  const std::array<Real, 4> c = power_cubic<Real>(problem);
  Real t0 = 0;
  Real t1 = 1;
  Real f0 = c[0];
  Real f1 = at(c, Real(1));
  std::array<Real, 2> places{};
  const int count = extrema(c, places);
  for (int i = 0; i < count; ++i) {
    const Real e = places[unsigned(i)];
    const Real fe = at(c, e);
    if ((fe < 0) != (f0 < 0)) {
      t1 = e;
      f1 = fe;
      break;
    }
    t0 = e;
    f0 = fe;
  }
  if ((f0 < 0) == (f1 < 0)) return std::nullopt;
  return interpolate([&c](Real t) { return at(c, t); }, t0, t1, f0, f1);
}

/// The trilinear interpolant itself, a part s of the way.
float value_at(const CellProblem& problem, float s) {
  std::array<float, 3> p{};
  for (unsigned a = 0; a < 3; ++a) p[a] = float(problem.enter[a]) + s * float(problem.leave[a] - problem.enter[a]);
  const auto mix = [](float u, float v, float t) { return u + t * (v - u); };
  const auto& v = problem.corners;
  return mix(mix(mix(float(v[0]), float(v[1]), p[0]), mix(float(v[2]), float(v[3]), p[0]), p[1]),
             mix(mix(float(v[4]), float(v[5]), p[0]), mix(float(v[6]), float(v[7]), p[0]), p[1]), p[2]);
}

/// A change of sign between entry and exit, then repeated linear interpolation: Neubauer, Mroz, Hauser & Wegenkittl
/// 2002, "Cell-based first-hit ray casting". Two roots in one cell go unseen, as the paper accepts.
CellRoot neubauer(const CellProblem& problem) {
  const float f0 = value_at(problem, 0.0f);
  const float f1 = value_at(problem, 1.0f);
  if ((f0 < 0) == (f1 < 0)) return std::nullopt;
  return interpolate([&problem](float t) { return value_at(problem, t); }, 0.0f, 1.0f, f0, f1);
}

/// The one root between 0 and 1 by Newton's steps, halving where they leave the bracket.
double bracketed_newton(const std::array<double, 4>& b) {
  constexpr int kMostSteps = 60;
  constexpr double kEnough = 1e-12;
  double low = 0.0;
  double high = 1.0;
  double s = b[0] / (b[0] - b[3]);
  for (int i = 0; i < kMostSteps; ++i) {
    const double f = cubic_at(b, s);
    ((f < 0) == (b[0] < 0) ? low : high) = s;
    const double r = 1.0 - s;
    const double slope = 3.0 * (r * r * (b[1] - b[0]) + 2.0 * r * s * (b[2] - b[1]) + s * s * (b[3] - b[2]));
    double next = s - f / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::fabs(next - s) < kEnough) return next;
    s = next;
  }
  return s;
}

/// Bernstein coefficients halved until they change sign once, the first half first: Lane & Riesenfeld 1981, "Bounds on
/// a polynomial".
CellRoot subdivided(const std::array<double, 4>& b, double from, double to, int depth) {
  int changes = 0;
  for (unsigned i = 1; i < 4; ++i) changes += (b[i] < 0) != (b[i - 1] < 0) ? 1 : 0;
  if (changes == 0) return std::nullopt;
  if (changes == 1) return from + (to - from) * bracketed_newton(b);
  if (depth == 0) return std::nullopt;
  const double ab = 0.5 * (b[0] + b[1]);
  const double bc = 0.5 * (b[1] + b[2]);
  const double cd = 0.5 * (b[2] + b[3]);
  const double abc = 0.5 * (ab + bc);
  const double bcd = 0.5 * (bc + cd);
  const double middle = 0.5 * (abc + bcd);
  const double half = 0.5 * (from + to);
  const CellRoot first = subdivided({b[0], ab, abc, middle}, from, half, depth - 1);
  return first ? first : subdivided({middle, bcd, cd, b[3]}, half, to, depth - 1);
}

CellRoot lane_riesenfeld(const CellProblem& problem) {
  constexpr int kHalvings = 24;
  return subdivided(segment_cubic(problem.corners, problem.enter, problem.leave), 0.0, 1.0, kHalvings);
}

/// Equal steps until the sign changes, then bisection: what volume renderers do.
template <int kSteps>
CellRoot marching(const CellProblem& problem) {
  constexpr int kBisections = 10;
  const bool begins_below = value_at(problem, 0.0f) < 0.0f;
  for (int i = 1; i <= kSteps; ++i) {
    float high = float(i) / kSteps;
    if ((value_at(problem, high) < 0.0f) == begins_below) continue;
    float low = float(i - 1) / kSteps;
    for (int b = 0; b < kBisections; ++b) {
      const float middle = 0.5f * (low + high);
      ((value_at(problem, middle) < 0.0f) == begins_below ? low : high) = middle;
    }
    return double(0.5f * (low + high));
  }
  return std::nullopt;
}

/// Ours: Bernstein coefficients and bracketed steps, the scalar tracer's own functions.
CellRoot bernstein(const CellProblem& problem) {
  std::array<double, 4> b = segment_cubic(problem.corners, problem.enter, problem.leave);
  if (b[0] == 0.0) return 0.0;
  if (b[0] > 0.0) {
    for (double& x : b) x = -x;
  }
  return first_root(b, RootWish::kPlace);
}

using Wide = long double;

}  // namespace

CellVerdict cell_oracle(const CellProblem& problem) {
  std::array<Wide, 4> c = power_cubic<Wide>(problem);
  Wide size = 0;
  for (const double v : problem.corners) size = std::max(size, std::fabs(Wide(v)));
  // A handful of roundings of double precision: what no double intersector can see.
  const Wide noise = 0x1p-46L * size;
  if (std::fabs(c[0]) <= noise) return {};
  if (c[0] > 0) {
    for (Wide& x : c) x = -x;
  }
  Wide low = 0;
  std::array<Wide, 2> places{};
  const int count = extrema(c, places);
  std::vector<Wide> ends(places.begin(), places.begin() + count);
  ends.push_back(1);
  for (const Wide high : ends) {
    const Wide value = at(c, high);
    if (std::fabs(value) <= noise) return {};
    if (value > 0) {
      Wide top = high;
      for (int i = 0; i < 70; ++i) {
        const Wide middle = (low + top) / 2;
        (at(c, middle) < 0 ? low : top) = middle;
      }
      return {.decided = true, .root = double(low)};
    }
    low = high;
  }
  return {.decided = true, .root = {}};
}

const std::vector<CellIntersector>& cell_intersectors() {
  static const std::vector<CellIntersector> all{
      {"isolux (Bernstein, deflated, bracketed)", bernstein},
      {"Lane & Riesenfeld 1981 (Bernstein)", lane_riesenfeld},
      {"Parker 1998, double", parker<double>},
      {"Parker 1998, float", parker<float>},
      {"Marmitt 2004, double", marmitt<double>},
      {"Marmitt 2004, float", marmitt<float>},
      {"Neubauer 2002, float", neubauer},
      {"4 steps + bisection, float", marching<4>},
      {"16 steps + bisection, float", marching<16>},
  };
  return all;
}

}  // namespace isolux::bench
