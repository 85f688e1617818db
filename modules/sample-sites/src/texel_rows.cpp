#include "texel_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace isolux {

TexelRows::TexelRows(const Volume& volume, const Lattice& texels)
    : volume_(volume), texels_(texels.size), to_volume_(index_to_index(texels, volume.lattice())) {
  // Off the axes there is rounding alone, or the lattice is another one.
  constexpr double kRounding = 1e-9;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      if (a != b && std::abs(to_volume_.axes[b][a]) * double(texels_[b]) > kRounding * double(volume.lattice().size[a]))
        is_aligned_ = false;
  for (int x = 0; x < texels_.x; ++x)
    columns_.push_back(between(0, to_volume_.origin.x + double(x) * to_volume_.axes[0].x));
  // Places are floats: off by up to 2^-24 of an axis, over which f changes by that part of its range a grid step.
  const ValueRange all = value_range(volume);
  const Index3& size = volume.lattice().size;
  const float place = 0x1p-21f * float(std::max({size.x, size.y, size.z}));
  margin_ = place * (all.high - all.low) + 0x1p-20f * std::max(std::abs(all.low), std::abs(all.high));
}

TexelRows::Between TexelRows::between(int axis, double at) const {
  const int last = volume_.lattice().size[axis] - 1;
  const double x = std::clamp(at, 0.0, double(last));
  const int first = std::min(int(x), last - 1);
  return {.first = first, .fraction = float(x - first)};
}

std::vector<float> TexelRows::values_along(std::size_t row) const {
  const Index3& size = volume_.lattice().size;
  const std::size_t j = row % std::size_t(texels_.y);
  const std::size_t k = row / std::size_t(texels_.y);
  const Between y = between(1, to_volume_.origin.y + double(j) * to_volume_.axes[1].y);
  const Between z = between(2, to_volume_.origin.z + double(k) * to_volume_.axes[2].z);
  std::vector<float> values(std::size_t(size.x), 0.0f);
  for (int corner = 0; corner < 4; ++corner) {
    const int up = corner & 1;
    const int on = corner >> 1;
    const float weight = (up != 0 ? y.fraction : 1.0f - y.fraction) * (on != 0 ? z.fraction : 1.0f - z.fraction);
    const float* from = volume_.values.values().data() + volume_.lattice().offset(0, y.first + up, z.first + on);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * from[i];
  }
  return values;
}

std::vector<int> TexelRows::columns_within(std::size_t row, const ValueRange& range) const {
  std::vector<int> columns;
  if (!is_aligned_) {
    columns.resize(columns_.size());
    std::iota(columns.begin(), columns.end(), 0);
    return columns;
  }
  const std::vector<float> values = values_along(row);
  const float low = range.low - margin_;
  const float high = range.high + margin_;
  for (std::size_t x = 0; x < columns_.size(); ++x) {
    const float* at = &values[std::size_t(columns_[x].first)];
    const float isovalue = at[0] + columns_[x].fraction * (at[1] - at[0]);
    if (isovalue >= low && isovalue <= high) columns.push_back(int(x));
  }
  return columns;
}

}  // namespace isolux
