#pragma once

#include <isolux/sample_sites/site_sampler.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// The cells in which sites can lie: those that are not constant and whose values meet the isovalue range. Maps the
/// unit cube onto them so that volume is kept: uniform points become uniform in the active cells. Where every cell is
/// active that is the plain scaling of the box. Immutable.
class ActiveCells {
 public:
  /// Cost: one pass over the volume. \throw Cancelled
  ActiveCells(const Volume& volume, const std::optional<ValueRange>& isovalues, const Run& run);

  /// The part of the box that is active, 0 to 1.
  [[nodiscard]] double fraction() const { return double(columns_.size()) / double(cell_count_); }
  [[nodiscard]] bool empty() const { return columns_.empty(); }
  [[nodiscard]] std::size_t size() const { return columns_.size(); }
  /// Active cell number n in the order of memory. \pre n < size(). Cost: a binary search.
  [[nodiscard]] Index3 cell(std::size_t n) const;
  /// The active point at place u, a point of [0,1)^3; index space. The inverse of the conditional distributions of z, y
  /// given z, x given both (Rosenblatt 1952, "Remarks on a multivariate transformation"): monotone in each coordinate,
  /// so neighbours mostly stay neighbours and the evenness of u mostly survives. \pre !empty().
  [[nodiscard]] Vec3f place(const Vec3& u) const;

 private:
  Index3 cells_{0};
  std::size_t cell_count_ = 0;
  std::vector<int> columns_;             ///< x of every active cell, row after row
  std::vector<std::size_t> row_begins_;  ///< of row j of slab k in columns_: [k * cells_.y + j]; one more at the end
};

}  // namespace isolux
