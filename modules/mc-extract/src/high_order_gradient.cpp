#include "high_order_gradient.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace isolux::mc {

namespace {

constexpr int kLongest = 9;  ///< grid points of an axis
/// Of fourth and sixth order; nine points from one side are about as good as seven round about.
constexpr Stencil kFirst{.off_grid = 4, .on_grid = 5, .on_face = 5};
constexpr Stencil kSecond{.off_grid = 6, .on_grid = 7, .on_face = kLongest};

/// Differences of an order, over those two orders lower, at which the higher stencil is taken wholly and not at all. A
/// wave of w radians a voxel has (2 sin(w/2))^2: 1 at six voxels a wave, 1.6 at four and a half; noise 3.4 and more.
constexpr double kSmooth = 1.0;
constexpr double kRough = 1.6;

double share(double ratio) {
  // In this order a NaN (no differences, or values that are not finite) gives nothing.
  return ratio < kRough ? std::min(1.0, (kRough - ratio) / (kRough - kSmooth)) : 0.0;
}

constexpr double factorial(int n) { return n < 2 ? 1.0 : n * factorial(n - 1); }

/// 1/((i - 0)(i - 1) ... (i - (count - 1))) without the factor i - i.
constexpr auto kScale = [] {
  std::array<std::array<double, kLongest>, kLongest + 1> scale{};
  for (int count = 1; count <= kLongest; ++count)
    for (int i = 0; i < count; ++i)
      scale[count][i] = ((count - 1 - i) % 2 == 0 ? 1.0 : -1.0) / (factorial(i) * factorial(count - 1 - i));
  return scale;
}();

}  // namespace

template <class Value>
struct HighOrderGradient<Value>::Weights {
  int first;
  int count;
  std::array<double, kLongest> value;
  std::array<double, kLongest> slope;
  int only = -1;  ///< at a grid point: the one whose value counts

  /// Lagrange's polynomials and their derivatives at x, counted from the first point: each is a product of differences
  /// to the points before and to those after.
  void set(double x) {
    std::array<double, kLongest + 1> after;
    std::array<double, kLongest + 1> after_slope;
    after[count] = 1.0;
    after_slope[count] = 0.0;
    for (int i = count - 1; i > 0; --i) {
      after[i] = after[i + 1] * (x - i);
      after_slope[i] = after_slope[i + 1] * (x - i) + after[i + 1];
    }
    double before = 1.0;
    double before_slope = 0.0;
    for (int i = 0; i < count; ++i) {
      value[i] = kScale[count][i] * before * after[i + 1];
      slope[i] = kScale[count][i] * (before_slope * after[i + 1] + before * after_slope[i + 1]);
      before_slope = before_slope * (x - i) + before;
      before *= x - i;
    }
  }
  [[nodiscard]] int begin() const { return only < 0 ? 0 : only; }
  [[nodiscard]] int end() const { return only < 0 ? count : only + 1; }
  [[nodiscard]] double sum_values(const Value* values) const {
    double sum = 0.0;
    for (int i = begin(); i < end(); ++i) sum += value[i] * values[i];
    return sum;
  }
  [[nodiscard]] double sum_slopes(const Value* values) const {
    double sum = 0.0;
    for (int i = 0; i < count; ++i) sum += slope[i] * values[i];
    return sum;
  }
};

template <class Value>
HighOrderGradient<Value>::HighOrderGradient(const TrilinearFieldOf<Value>& field, const Vec3& tolerance)
    : field_(field), size_(field.lattice().size), tolerance_(tolerance) {}

template <class Value>
bool HighOrderGradient<Value>::is_grid_point(const Vec3& index) const {
  for (int a = 0; a < 3; ++a)
    if (std::fabs(index[a] - std::round(index[a])) > tolerance_[a]) return false;
  return true;
}

template <class Value>
typename HighOrderGradient<Value>::Weights HighOrderGradient<Value>::weights(double x, int axis,
                                                                             const Stencil& stencil) const {
  const int size = size_[axis];
  x = within_axis(x, size);
  const double nearest = std::round(x);
  const bool on_grid = std::fabs(x - nearest) <= tolerance_[axis];
  if (on_grid) x = nearest;
  const auto first_of = [&](int count) { return on_grid ? int(x) - count / 2 : int(x) - count / 2 + 1; };
  Weights result;
  result.count = on_grid ? stencil.on_grid : stencil.off_grid;
  result.first = first_of(result.count);
  if (result.first < 0 || result.first + result.count > size) {
    result.count = std::min(on_grid ? stencil.on_face : stencil.off_grid, size);
    result.first = std::clamp(first_of(result.count), 0, size - result.count);
  }
  result.set(x - result.first);
  if (on_grid) result.only = int(x) - result.first;
  return result;
}

template <class Value>
Vec3 HighOrderGradient<Value>::gradient(const Vec3& index, const Stencil& stencil) const {
  const Weights x = weights(index.x, 0, stencil);
  const Weights y = weights(index.y, 1, stencil);
  const Weights z = weights(index.z, 2, stencil);
  const auto row = [&](int j, int k) {
    return field_.data() + field_.lattice().offset(x.first, y.first + j, z.first + k);
  };
  Vec3 g(0.0);
  for (int k = z.begin(); k < z.end(); ++k) {
    for (int j = y.begin(); j < y.end(); ++j) g.x += z.value[k] * y.value[j] * x.sum_slopes(row(j, k));
    for (int j = 0; j < y.count; ++j) g.y += z.value[k] * y.slope[j] * x.sum_values(row(j, k));
  }
  for (int k = 0; k < z.count; ++k)
    for (int j = y.begin(); j < y.end(); ++j) g.z += z.slope[k] * y.value[j] * x.sum_values(row(j, k));
  return g;
}

template <class Value>
typename HighOrderGradient<Value>::Smoothness HighOrderGradient<Value>::smoothness(const Vec3& index) const {
  // Mean squares of second, fourth and sixth differences along the three grid lines through the nearest voxel.
  std::array<double, 3> squares{};
  std::array<int, 3> counts{};
  Index3 nearest;
  for (int a = 0; a < 3; ++a) nearest[a] = std::clamp(int(std::round(index[a])), 0, size_[a] - 1);
  const std::array<std::size_t, 3> steps = {1, std::size_t(size_.x), std::size_t(size_.x) * std::size_t(size_.y)};
  for (int a = 0; a < 3; ++a) {
    int count = std::min(kLongest, size_[a]);
    Index3 first = nearest;
    first[a] = std::clamp(nearest[a] - kLongest / 2, 0, size_[a] - count);
    const Value* values = field_.data() + field_.lattice().offset(first.x, first.y, first.z);
    std::array<double, kLongest> line;
    for (int i = 0; i < count; ++i) line[i] = values[std::size_t(i) * steps[a]];
    for (std::size_t order = 1; order <= 6 && count > 1; ++order) {
      --count;
      for (int i = 0; i < count; ++i) line[i] = line[i + 1] - line[i];
      if (order % 2 != 0) continue;
      for (int i = 0; i < count; ++i) squares[order / 2 - 1] += line[i] * line[i];
      counts[order / 2 - 1] += count;
    }
  }
  const auto ratio = [&](int higher) {
    return std::sqrt(squares[higher] * counts[higher - 1] / (squares[higher - 1] * counts[higher]));
  };
  return {.first = share(ratio(1)), .second = share(ratio(2))};
}

template <class Value>
std::optional<Vec3> HighOrderGradient<Value>::at(const Vec3& index) const {
  const Smoothness smooth = smoothness(index);
  if (smooth.first == 0.0) return std::nullopt;
  Vec3 g(0.0);
  if (smooth.second < 1.0) g += (1.0 - smooth.second) * gradient(index, kFirst);
  if (smooth.second > 0.0) g += smooth.second * gradient(index, kSecond);
  if (smooth.first < 1.0) g = smooth.first * g + (1.0 - smooth.first) * field_.smooth_gradient(index);
  const double largest = std::max({std::fabs(g.x), std::fabs(g.y), std::fabs(g.z)});
  if (!(largest > 0.0 && largest < std::numeric_limits<double>::infinity())) return std::nullopt;
  return g / largest;
}

template class HighOrderGradient<float>;
template class HighOrderGradient<std::uint8_t>;
template class HighOrderGradient<std::int8_t>;
template class HighOrderGradient<std::uint16_t>;
template class HighOrderGradient<std::int16_t>;

}  // namespace isolux::mc
