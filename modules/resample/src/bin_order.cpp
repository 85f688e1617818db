#include "bin_order.h"

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

/// Bounds the bins' memory on boxes that are far longer than wide.
constexpr int kMostBins = 2048;

}  // namespace

BinOrder::BinOrder(std::span<const Point> given, const Point& far_corner, double points_a_bin) {
  double volume = 1.0;
  float longest = 0.0f;
  for (int a = 0; a < 3; ++a) {
    volume *= double(far_corner.x[a]);
    longest = std::max(longest, far_corner.x[a]);
  }
  side = std::max(float(std::cbrt(volume * points_a_bin / double(given.size()))), longest / float(kMostBins));
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
