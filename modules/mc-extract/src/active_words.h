#pragma once

#include <isolux/core/run.h>

#include <cstdint>
#include <vector>

#include "brick_index.h"

namespace isolux::mc {

/// Which words (64 cells of a row) a level set passes through, by the index of bricks: what the sparse way reads. Kept
/// from one isovalue to the next for its memory.
class ActiveWords {
 public:
  /// Looks the level set up. Follows the surface: layers, then rows of bricks, then bricks; only bits are cleared.
  void find(const BrickIndex& index, const ExtractSettings& settings, const Run& run, int words);

  /// The part of all bricks that hold both sides.
  [[nodiscard]] double share() const { return share_; }
  /// The bricks of a word that hold both sides: bit b for brick 4 word + b. 0 for a negative row, layer or word.
  [[nodiscard]] std::uint8_t own(int word, int row, int layer) const {
    return word < 0 || row < 0 || layer < 0 ? std::uint8_t(0) : bricks_[at(row, layer) * std::size_t(words_) + word];
  }
  /// Whether any word of this row of bricks is active, or of those below it that reach to its first grid points.
  [[nodiscard]] bool reaches_row(int row, int layer) const {
    return row_is_active(row, layer) || row_is_active(row - 1, layer) || row_is_active(row, layer - 1) ||
           row_is_active(row - 1, layer - 1);
  }
  [[nodiscard]] bool row_is_active(int row, int layer) const {
    return row >= 0 && layer >= 0 && active_rows_[at(row, layer)] != 0;
  }

 private:
  [[nodiscard]] std::size_t at(int row, int layer) const { return std::size_t(layer) * std::size_t(rows_) + row; }

  int words_ = 0;
  int rows_ = 0;
  double share_ = 0.0;
  std::vector<std::uint8_t> bricks_;       ///< [layers][rows][words]
  std::vector<std::uint8_t> active_rows_;  ///< [layers][rows]
};

}  // namespace isolux::mc
