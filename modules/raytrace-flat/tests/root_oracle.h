// An independent judge of ray/level-set intersections: long double, power basis, roots isolated at the roots of the
// derivatives, every cell of the box visited, no acceleration. It also says when it cannot decide.
#pragma once

#include <isolux/core/field.h>
#include <isolux/core/volume.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace isolux::test {

using Real = long double;

struct OracleAnswer {
  bool decided = false;
  std::optional<double> t;  ///< the first hit, if there is one
};

class RootOracle {
 public:
  explicit RootOracle(const Volume& volume) : volume_(volume) {}

  /// A ray that starts on its level set; as LevelSetIntersector::next_hit.
  [[nodiscard]] OracleAnswer next_hit(const Vec3& origin, const Vec3& direction, OuterSide outer) const {
    const std::vector<Segment> way = segments(origin, direction);
    if (way.empty()) return {.decided = true, .t = {}};
    return judge(way, direction, way.front().f[0], outer == OuterSide::kLower ? 1.0L : -1.0L, true);
  }

  /// A ray from anywhere inside the box, met from either side.
  [[nodiscard]] OracleAnswer first_hit(const Vec3& origin, const Vec3& direction, double isovalue) const {
    const std::vector<Segment> way = segments(origin, direction);
    if (way.empty()) return {.decided = true, .t = {}};
    const Real value = way.front().f[0] - Real(isovalue);
    if (std::fabs(value) <= kNoise * way.front().size) return {};
    return judge(way, direction, Real(isovalue), value < 0 ? 1.0L : -1.0L, false);
  }

 private:
  // Double precision carries 53 bits; a handful of roundings of the largest corner value is what it cannot see.
  static constexpr Real kNoise = 0x1p-46L;

  /// The way through one cell, f along it as a polynomial of s in [0, 1].
  struct Segment {
    Real begin;
    Real end;
    std::array<Real, 4> f;
    Real size;  ///< largest corner value in magnitude
  };

  using Polynomial = std::vector<Real>;

  static Real at(const Polynomial& p, Real s) {
    Real sum = 0;
    for (std::size_t i = p.size(); i-- > 0;) sum = sum * s + p[i];
    return sum;
  }

  // Where p, negative at 0, first is zero or more in (0, 1]: between neighbouring roots of its derivative it is
  // monotonic.
  static std::optional<Real> first_not_negative(const Polynomial& p) {
    Real low = 0;
    for (const Real high : roots_and_end(derivative(p))) {
      if (at(p, high) >= 0) return bisect(p, low, high);
      low = high;
    }
    return std::nullopt;
  }

  static Polynomial derivative(const Polynomial& p) {
    Polynomial d;
    for (std::size_t i = 1; i < p.size(); ++i) d.push_back(Real(i) * p[i]);
    return d;
  }

  static Real bisect(const Polynomial& p, Real low, Real high) {
    const bool rising = at(p, high) >= 0;
    for (int i = 0; i < 80; ++i) {
      const Real middle = (low + high) / 2;
      ((at(p, middle) >= 0) == rising ? high : low) = middle;
    }
    return high;
  }

  // The roots of p in (0, 1), ascending, and 1.
  static std::vector<Real> roots_and_end(const Polynomial& p) {
    std::vector<Real> result;
    if (p.size() > 1) {
      Real low = 0;
      for (const Real high : roots_and_end(derivative(p))) {
        if ((at(p, low) < 0) != (at(p, high) < 0)) result.push_back(bisect(p, low, high));
        low = high;
      }
    }
    result.push_back(1);
    return result;
  }

  [[nodiscard]] std::vector<Segment> segments(const Vec3& origin, const Vec3& direction) const {
    const Index3 size = volume_.lattice().size;
    Real leave = std::numeric_limits<Real>::infinity();
    for (int a = 0; a < 3; ++a) {
      if (direction[a] == 0.0) continue;
      const Real wall = direction[a] > 0.0 ? size[a] - 1 : 0;
      leave = std::min(leave, (wall - Real(origin[a])) / Real(direction[a]));
    }
    std::vector<Real> planes{0, leave};
    for (int a = 0; a < 3; ++a) {
      if (direction[a] == 0.0) continue;
      for (int k = 0; k < size[a]; ++k) {
        const Real t = (Real(k) - Real(origin[a])) / Real(direction[a]);
        if (t > 0 && t < leave) planes.push_back(t);
      }
    }
    std::sort(planes.begin(), planes.end());
    std::vector<Segment> way;
    for (std::size_t i = 1; i < planes.size(); ++i)
      if (planes[i] > planes[i - 1]) way.push_back(segment(origin, direction, planes[i - 1], planes[i]));
    return way;
  }

  [[nodiscard]] Segment segment(const Vec3& origin, const Vec3& direction, Real begin, Real end) const {
    const Index3 size = volume_.lattice().size;
    // Never zero, so that cells of zeros are undecided as all flat ones are.
    Segment result{.begin = begin, .end = end, .f = {}, .size = 1e-60L};
    int cell[3];
    Real place[3];
    Real way[3];
    for (int a = 0; a < 3; ++a) {
      const Real middle = Real(origin[a]) + (begin + end) / 2 * Real(direction[a]);
      cell[a] = std::clamp(int(std::floor(middle)), 0, size[a] - 2);
      place[a] = Real(origin[a]) + begin * Real(direction[a]) - cell[a];
      way[a] = (end - begin) * Real(direction[a]);
    }
    for (int q = 0; q < 8; ++q) {
      const Real value = volume_.values(cell[0] + (q & 1), cell[1] + (q >> 1 & 1), cell[2] + (q >> 2));
      result.size = std::max(result.size, std::fabs(value));
      std::array<Real, 4> product{value, 0, 0, 0};
      for (int a = 0; a < 3; ++a) {
        const bool high = (q >> a & 1) != 0;
        const Real constant = high ? place[a] : 1 - place[a];
        const Real slope = high ? way[a] : -way[a];
        for (int i = 3; i >= 0; --i)
          product[std::size_t(i)] =
              product[std::size_t(i)] * constant + (i > 0 ? product[std::size_t(i) - 1] * slope : 0);
      }
      for (std::size_t i = 0; i < 4; ++i) result.f[i] += product[i];
    }
    return result;
  }

  // The first hit if every value of f were `shift` times the noise nearer to the inner side.
  [[nodiscard]] static std::optional<Real> solve(const std::vector<Segment>& way, Real level, Real inner, bool fresh,
                                                 Real shift) {
    // A start on the level set gives the level, rounded as values of its cell are.
    const Real level_size = fresh ? way.front().size : 0;
    for (const Segment& part : way) {
      const Real noise = shift * kNoise * std::max(part.size, level_size);
      const auto& f = part.f;
      std::optional<Real> s;
      if (fresh) {
        const Polynomial q{inner * f[1] + noise, inner * f[2], inner * f[3]};
        if (q[0] >= 0) return part.begin;
        s = first_not_negative(q);
      } else {
        const Polynomial g{inner * (f[0] - level) + noise, inner * f[1], inner * f[2], inner * f[3]};
        if (g[0] >= 0) return part.begin;
        s = first_not_negative(g);
      }
      if (s) return part.begin + *s * (part.end - part.begin);
      fresh = false;
    }
    return std::nullopt;
  }

  [[nodiscard]] static OracleAnswer judge(const std::vector<Segment>& way, const Vec3& direction, Real level,
                                          Real inner, bool fresh) {
    const auto middle = solve(way, level, inner, fresh, 0);
    const Real speed = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
    for (const Real shift : {-1.0L, 1.0L}) {
      const auto other = solve(way, level, inner, fresh, shift);
      if (other.has_value() != middle.has_value()) return {};
      // An answer that noise moves by a tenth of the tolerance is none.
      if (middle && std::fabs(*other - *middle) * speed > 1e-5L) return {};
    }
    if (!middle) return {.decided = true, .t = {}};
    return {.decided = true, .t = double(*middle)};
  }

  const Volume& volume_;
};

}  // namespace isolux::test
