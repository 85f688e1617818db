#pragma once

#include <isolux/core/sample_set.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace isolux::wide {

/// Aligned cubes of 2^n voxels an axis, from the first to the last that holds a site.
class SiteCells {
 public:
  struct Cell {
    std::uint32_t x;
    std::uint32_t y;
    std::uint32_t z;
  };
  static constexpr int kLargest = 10;     ///< n
  static constexpr double kAlone = 1.02;  ///< sites a cell: a lattice of texels, but for roundings

  SiteCells(const Sites& sites, int n);

  [[nodiscard]] Cell of(const Vec3f& position) const;
  /// One past the last cell that holds a site, along each axis.
  [[nodiscard]] const Cell& end() const { return end_; }

 private:
  int n_;
  Cell end_{0, 0, 0};
};

/// A bit for each cell, in rows along x.
class CellBits {
 public:
  explicit CellBits(const SiteCells::Cell& end)
      : end_(end),
        words_((std::size_t(end.x) + 63) / 64),
        rows_(end.y),
        planes_(end.z),
        bits_(words_ * rows_ * planes_) {}

  void set(const SiteCells::Cell& cell) { word(cell) |= std::uint64_t(1) << (cell.x % 64); }
  [[nodiscard]] bool operator[](const SiteCells::Cell& cell) const {
    return (bits_[offset(cell)] >> (cell.x % 64) & 1) != 0;
  }
  /// Sets the 26 cells about each one that is set.
  void dilate();
  /// How many of a cell and the 26 about it are set.
  [[nodiscard]] int count_about(const SiteCells::Cell& cell) const;

 private:
  [[nodiscard]] std::size_t offset(const SiteCells::Cell& cell) const {
    return (std::size_t(cell.z) * rows_ + cell.y) * words_ + cell.x / 64;
  }
  [[nodiscard]] std::uint64_t& word(const SiteCells::Cell& cell) { return bits_[offset(cell)]; }
  void dilate_rows();
  /// Sets what is set `stride` words on or before within each of the runs of so many words.
  void dilate_along(std::size_t stride, std::size_t run);

  SiteCells::Cell end_;
  std::size_t words_;  ///< a row
  std::size_t rows_;   ///< a plane
  std::size_t planes_;
  std::vector<std::uint64_t> bits_;
};

/// The cells that hold a site.
struct HeldCells {
  SiteCells cells;
  CellBits bits;
  double sites_a_cell;

  HeldCells(const Sites& sites, int n);
};

}  // namespace isolux::wide
