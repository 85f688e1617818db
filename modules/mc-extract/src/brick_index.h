#pragma once

#include <isolux/core/run.h>
#include <isolux/core/volume.h>
#include <isolux/mc_extract/extractor.h>

#include <cstdint>
#include <vector>

namespace isolux::mc {

/// Smallest and largest value of every brick of 16 x 4 x 4 cells (its grid points on all sides included), of every row
/// of bricks along x and of every layer of rows: a hierarchy of three levels, so that the bricks of a level set are
/// found without reading the volume, nor much more than their rows. 1/32 of a byte a voxel; made in one pass. A
/// search by span space (Livnat, Shen & Johnson 1996) would save the rows too, but needs sorting and gives bricks out
/// of order.
class BrickIndex {
 public:
  static constexpr int kWidth = 16;  ///< cells along x
  static constexpr int kHeight = 4;  ///< cells along y and z
  static constexpr int kBricksPerWord = 64 / kWidth;

  BrickIndex(const VolumeView& volume, const Run& run);

  [[nodiscard]] int rows() const { return bricks_.y; }
  [[nodiscard]] int layers() const { return bricks_.z; }
  /// Whether any brick of a layer may hold both sides of the level set.
  [[nodiscard]] bool layer_is_mixed(const ExtractSettings& settings, int layer) const;
  /// For one row of bricks: sets bit b of activity[word] where brick 4 word + b holds both sides of the level set, and
  /// gives their number. `activity` is clear before.
  [[nodiscard]] int find_active(const ExtractSettings& settings, int row, int layer, std::uint8_t* activity) const;
  /// Whether the first grid point of a brick is inside: all of it is, where it is not active.
  [[nodiscard]] bool inside(const ExtractSettings& settings, int brick, int row, int layer) const;
  [[nodiscard]] int bricks_in_row() const { return bricks_.x; }

 private:
  [[nodiscard]] std::size_t row_number(int row, int layer) const { return std::size_t(layer) * bricks_.y + row; }

  Index3 bricks_;
  std::vector<float> low_, high_;
  std::vector<float> row_low_, row_high_;
  std::vector<float> layer_low_, layer_high_;
};

}  // namespace isolux::mc
