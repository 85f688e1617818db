#pragma once

#include <cmath>
#include <cstdint>

namespace isolux {

enum class Distance : std::uint8_t { kEuclidean, kCityBlock, kChebyshev };

/// A place along the box's axes and, as the fourth coordinate, its scaled isovalue, all in mean grid spacings.
struct Point {
  float x[4];
};

// A metric's `reach` is a rising function of the distance, the same bits wherever it is called; `axis` is the reach of
// a step along one axis, `join` that of steps along several, `kPower` the power of the reach that is the distance. No
// reach is less than that of its largest axis.

struct EuclideanMetric {
  static constexpr double kPower = 0.5;
  static float axis(float step) { return step * step; }
  static float join(float a, float b) { return a + b; }
};

struct CityBlockMetric {
  static constexpr double kPower = 1.0;
  static float axis(float step) { return std::fabs(step); }
  static float join(float a, float b) { return a + b; }
};

struct ChebyshevMetric {
  static constexpr double kPower = 1.0;
  static float axis(float step) { return std::fabs(step); }
  static float join(float a, float b) { return a > b ? a : b; }
};

template <class Metric>
float reach(const Point& p, const Point& q) {
  const float xy = Metric::join(Metric::axis(p.x[0] - q.x[0]), Metric::axis(p.x[1] - q.x[1]));
  const float zh = Metric::join(Metric::axis(p.x[2] - q.x[2]), Metric::axis(p.x[3] - q.x[3]));
  return Metric::join(xy, zh);
}

/// Calls `use` with the metric of a distance.
template <class Use>
auto with_metric(Distance distance, Use use) {
  switch (distance) {
    case Distance::kCityBlock:
      return use(CityBlockMetric{});
    case Distance::kChebyshev:
      return use(ChebyshevMetric{});
    case Distance::kEuclidean:
      break;
  }
  return use(EuclideanMetric{});
}

}  // namespace isolux
