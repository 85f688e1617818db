#include "bin_order.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace isolux {
namespace {

/// Bounds the bins' memory on boxes that are far longer than wide.
constexpr int kMostBins = 2048;

/// The side of `bins` cubes that fill the box. An axis shorter than that has one bin, and counts no more:
/// cubes as small as a flat box's volume asks for would be all but empty.
float bin_side(const Point& far_corner, double bins) {
  std::array<double, 3> lengths{};
  for (std::size_t a = 0; a < 3; ++a) lengths[a] = double(far_corner.x[a]);
  std::sort(lengths.begin(), lengths.end());
  double side = std::cbrt(lengths[0] * lengths[1] * lengths[2] / bins);
  if (lengths[0] <= side) side = std::sqrt(lengths[1] * lengths[2] / bins);
  if (lengths[1] <= side) side = lengths[2] / bins;
  return std::max(float(side), float(lengths[2]) / float(kMostBins));
}

}  // namespace

BinOrder::BinOrder(std::span<const Point> given, const Point& far_corner, double points_a_bin) {
  side = bin_side(far_corner, double(given.size()) / points_a_bin);
  for (std::size_t a = 0; a < 3; ++a) size[a] = std::max(1, int(std::ceil(far_corner.x[a] / side)));

  std::vector<std::size_t> bins(given.size());
  starts.assign(offset(0, 0, size[2]) + 1, 0);
  for (std::size_t p = 0; p < given.size(); ++p) {
    const auto [i, j, k] = bin(given[p]);
    bins[p] = offset(i, j, k);
    ++starts[bins[p] + 1];
  }
  for (std::size_t b = 1; b < starts.size(); ++b) starts[b] += starts[b - 1];
  std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
  points.resize(given.size());
  for (std::size_t p = 0; p < given.size(); ++p) points[next[bins[p]]++] = std::uint32_t(p);
}

std::array<int, 3> BinOrder::bin(const Point& p) const {
  std::array<int, 3> result{};
  for (std::size_t a = 0; a < 3; ++a) {
    const float b = p.x[a] / side;
    result[a] = b > 0.0f ? int(std::min(b, float(size[a] - 1))) : 0;
  }
  return result;
}

}  // namespace isolux
