#include "wide/site_cells.h"

#include <algorithm>

namespace isolux::wide {

SiteCells::SiteCells(const Sites& sites, int n) : n_(n) {
  for (const Vec3f& position : sites.positions) {
    const Cell cell = of(position);
    end_ = {std::max(end_.x, cell.x + 1), std::max(end_.y, cell.y + 1), std::max(end_.z, cell.z + 1)};
  }
}

SiteCells::Cell SiteCells::of(const Vec3f& position) const {
  const auto index = [this](float p) { return std::uint32_t(std::max(0.0f, p)) >> n_; };
  return {index(position.x), index(position.y), index(position.z)};
}

HeldCells::HeldCells(const Sites& sites, int n) : cells(sites, n), bits(cells.end()), sites_a_cell(0.0) {
  std::size_t held = 0;
  for (const Vec3f& position : sites.positions) {
    const SiteCells::Cell cell = cells.of(position);
    held += std::size_t(!bits[cell]);
    bits.set(cell);
  }
  if (held > 0) sites_a_cell = double(sites.size()) / double(held);
}

int CellBits::count_about(const SiteCells::Cell& cell) const {
  const auto from = [](std::uint32_t i) { return i == 0 ? 0 : i - 1; };
  int count = 0;
  for (std::uint32_t z = from(cell.z); z < std::min(cell.z + 2, end_.z); ++z)
    for (std::uint32_t y = from(cell.y); y < std::min(cell.y + 2, end_.y); ++y)
      for (std::uint32_t x = from(cell.x); x < std::min(cell.x + 2, end_.x); ++x) count += int((*this)[{x, y, z}]);
  return count;
}

void CellBits::dilate() {
  dilate_rows();
  dilate_along(words_, words_ * rows_);
  dilate_along(words_ * rows_, bits_.size());
}

void CellBits::dilate_rows() {
  for (std::size_t row = 0; row < bits_.size(); row += words_) {
    std::uint64_t before = 0;
    for (std::size_t w = row; w < row + words_; ++w) {
      const std::uint64_t here = bits_[w];
      const std::uint64_t after = w + 1 < row + words_ ? bits_[w + 1] : 0;
      bits_[w] = here | here << 1 | here >> 1 | before >> 63 | after << 63;
      before = here;
    }
  }
}

void CellBits::dilate_along(std::size_t stride, std::size_t run) {
  std::vector<std::uint64_t> before(stride);
  for (std::size_t begin = 0; begin < bits_.size(); begin += run) {
    std::fill(before.begin(), before.end(), 0);
    for (std::size_t step = begin; step < begin + run; step += stride) {
      for (std::size_t w = 0; w < stride; ++w) {
        const std::uint64_t here = bits_[step + w];
        const std::uint64_t after = step + stride < begin + run ? bits_[step + stride + w] : 0;
        bits_[step + w] = here | before[w] | after;
        before[w] = here;
      }
    }
  }
}

}  // namespace isolux::wide
