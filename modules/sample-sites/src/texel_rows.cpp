#include "texel_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace isolux {

TexelRows::TexelRows(const Volume& volume, const SiteRequest& request)
    : volume_(volume),
      texels_(request.texels.size),
      to_volume_(index_to_index(request.texels, volume.lattice())),
      is_aligned_(has_axes_of(request.texels, volume.lattice())) {
  for (int x = 0; x < texels_.x; ++x) {
    const Between at = between(0, to_volume_.origin.x + double(x) * to_volume_.axes[0].x);
    firsts_.push_back(at.first);
    fractions_.push_back(at.fraction);
    is_one_a_cell_ = is_one_a_cell_ && at.first == x;
  }
  // Places are floats: off by up to 2^-24 of an axis, over which f changes by that part of its range a grid step.
  if (!request.isovalues) return;
  const ValueRange all = request.values ? *request.values : value_range(volume);
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

void TexelRows::find_values(std::size_t row, std::vector<float>& values) const {
  const Index3& size = volume_.lattice().size;
  const std::size_t j = row % std::size_t(texels_.y);
  const std::size_t k = row / std::size_t(texels_.y);
  const Between y = between(1, to_volume_.origin.y + double(j) * to_volume_.axes[1].y);
  const Between z = between(2, to_volume_.origin.z + double(k) * to_volume_.axes[2].z);
  const float* here = volume_.values.values().data() + volume_.lattice().offset(0, y.first, z.first);
  const float* above = here + std::size_t(size.x) * std::size_t(size.y);
  const auto nx = std::size_t(size.x);
  values.resize(nx);
  float* const out = values.data();
  for (std::size_t i = 0; i < nx; ++i) {
    const float low = here[i] + y.fraction * (here[nx + i] - here[i]);
    const float high = above[i] + y.fraction * (above[nx + i] - above[i]);
    out[i] = low + z.fraction * (high - low);
  }
}

void TexelRows::find_within(const ValueRange& range, Scratch& scratch) const {
  const float low = range.low - margin_;
  const float high = range.high + margin_;
  const std::size_t count = firsts_.size();
  scratch.within.assign((count + 7) / 8 * 8, 0);
  const float* const values = scratch.values.data();
  const float* const fractions = fractions_.data();
  std::uint8_t* const within = scratch.within.data();
  const auto is_within = [&](const float* at, float fraction) {
    const float isovalue = at[0] + fraction * (at[1] - at[0]);
    return std::uint8_t(int(isovalue >= low) & int(isovalue <= high));
  };
  if (is_one_a_cell_) {  // a loop of its own: without a table of places it is done by vectors
    for (std::size_t x = 0; x < count; ++x) within[x] = is_within(values + x, fractions[x]);
  } else {
    for (std::size_t x = 0; x < count; ++x) within[x] = is_within(values + firsts_[x], fractions[x]);
  }
}

std::span<const int> TexelRows::columns_within(std::size_t row, const ValueRange& range, Scratch& scratch) const {
  std::vector<int>& columns = scratch.columns;
  columns.clear();
  if (!is_aligned_) {
    columns.resize(firsts_.size());
    std::iota(columns.begin(), columns.end(), 0);
    return columns;
  }
  find_values(row, scratch.values);
  find_within(range, scratch);
  for (std::size_t x = 0; x < scratch.within.size(); x += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, &scratch.within[x], 8);
    if (eight == 0) continue;
    for (std::size_t i = x; i < x + 8; ++i)
      if (scratch.within[i] != 0) columns.push_back(int(i));
  }
  return columns;
}

}  // namespace isolux
