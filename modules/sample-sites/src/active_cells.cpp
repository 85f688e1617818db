#include "active_cells.h"

#include <isolux/core/parallel.h>

#include <algorithm>

namespace isolux {
namespace {

/// x of the active cells of one row.
std::vector<int> active_columns(const Volume& volume, const std::optional<ValueRange>& range, int j, int k) {
  const Grid<float>& f = volume.values;
  std::vector<int> columns;
  ValueRange before{};
  for (int i = 0; i < f.size().x; ++i) {
    const auto [low, high] = std::minmax({f(i, j, k), f(i, j + 1, k), f(i, j, k + 1), f(i, j + 1, k + 1)});
    if (i > 0) {
      const float cell_low = std::min(low, before.low);
      const float cell_high = std::max(high, before.high);
      if (cell_low < cell_high && (!range || (cell_low <= range->high && cell_high >= range->low))) {
        columns.push_back(i - 1);
      }
    }
    before = {.low = low, .high = high};
  }
  return columns;
}

}  // namespace

ActiveCells::ActiveCells(const Volume& volume, const std::optional<ValueRange>& isovalues, const Run& run)
    : cells_(volume.lattice().size - 1),
      cell_count_(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z)) {
  const std::size_t rows = std::size_t(cells_.y) * std::size_t(cells_.z);
  std::vector<std::vector<int>> of_row(rows);
  parallel_blocks(rows, 64, run, {}, [&](const Block& block) {
    for (std::size_t r = block.begin; r < block.end; ++r) {
      of_row[r] = active_columns(volume, isovalues, int(r % std::size_t(cells_.y)), int(r / std::size_t(cells_.y)));
    }
  });
  row_begins_.reserve(rows + 1);
  row_begins_.push_back(0);
  for (const auto& row : of_row) row_begins_.push_back(row_begins_.back() + row.size());
  columns_.reserve(row_begins_.back());
  for (const auto& row : of_row) columns_.insert(columns_.end(), row.begin(), row.end());
}

Index3 ActiveCells::cell(std::size_t n) const {
  const auto row = std::size_t(std::upper_bound(row_begins_.begin(), row_begins_.end(), n) - row_begins_.begin()) - 1;
  const auto rows = std::size_t(cells_.y);
  return {columns_[n], int(row % rows), int(row / rows)};
}

Vec3f ActiveCells::place(const Vec3& u) const {
  if (columns_.size() == cell_count_) return Vec3f(u * Vec3(cells_));

  // Item `at` (a real number in [begins[first], begins[last])) of consecutive groups: the group, and `at`'s place in
  // it.
  struct Found {
    std::size_t group;
    double place;
  };
  const auto find = [this](double at, std::size_t first, std::size_t last, std::size_t stride) {
    std::size_t low = 0;
    std::size_t high = (last - first) / stride;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (double(row_begins_[first + middle * stride]) <= at ? low : high) = middle;
    }
    const double begin = double(row_begins_[first + low * stride]);
    const double end = double(row_begins_[first + (low + 1) * stride]);
    return Found{.group = low, .place = std::clamp((at - begin) / (end - begin), 0.0, 1.0)};
  };
  const std::size_t rows = row_begins_.size() - 1;
  const auto slab = find(u.z * double(columns_.size()), 0, rows, std::size_t(cells_.y));
  const std::size_t slab_row = slab.group * std::size_t(cells_.y);
  const double slab_begin = double(row_begins_[slab_row]);
  const double slab_end = double(row_begins_[slab_row + std::size_t(cells_.y)]);
  const auto row = find(slab_begin + u.y * (slab_end - slab_begin), slab_row, slab_row + std::size_t(cells_.y), 1);
  const std::size_t begin = row_begins_[slab_row + row.group];
  const std::size_t size = row_begins_[slab_row + row.group + 1] - begin;
  const double along = u.x * double(size);
  const std::size_t nth = std::min(std::size_t(along), size - 1);
  return Vec3f(Vec3(columns_[begin + nth] + (along - double(nth)), double(row.group) + row.place,
                    double(slab.group) + slab.place));
}

}  // namespace isolux
