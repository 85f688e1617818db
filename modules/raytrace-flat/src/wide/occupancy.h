#pragma once

#include <isolux/core/run.h>

#include <cstdint>
#include <span>
#include <vector>

#include "wide/rays.h"

namespace isolux::wide {

/// Cells along an axis of a brick.
inline constexpr int kBrick = 4;

/// For every cell, how many of a few rising thresholds its largest value reaches (smallest, for the outer side of
/// higher values; thresholds are then negated isovalues). Half a byte a cell, brick by brick, 32 bytes each: the cells
/// z < 2 in the lower halves, those above them in the upper ones. The occupancy for any of the thresholds is then a
/// compare of bytes. Rays run on the outer side, so no other extreme of a cell matters.
class CellCodes {
 public:
  static constexpr std::size_t kMaxThresholds = 15;

  explicit CellCodes(const FieldView& field);

  /// \pre at most kMaxThresholds. Cost: one pass over the volume.
  void build(std::span<const float> thresholds, const Run& run);

  [[nodiscard]] Index3 bricks() const { return bricks_; }
  [[nodiscard]] std::span<const std::uint8_t> codes() const { return codes_; }

 private:
  FieldView field_;
  Index3 bricks_{0};
  std::vector<std::uint8_t> codes_;
};

/// Which cells a ray of some isovalues must look into, and how far it may leap: one bit a cell and, for each octant of
/// directions, one chessboard distance a brick (after Sramek & Kaufman, "Fast ray-tracing of rectilinear volume data
/// using distance transforms", IEEE TVCG 2000). docs/tracer.md has a picture.
class Occupancy {
 public:
  explicit Occupancy(const CellCodes& codes);

  /// For isovalues of the threshold `index` of the codes and above. Cost: two compares a byte; the distances are bit
  /// operations.
  void build(const CellCodes& codes, int index, const Run& run);
  /// \pre built
  [[nodiscard]] OccupancyView view() const { return {words_.data(), bricks_}; }

 private:
  void find_occupied();
  void measure_leaps(unsigned octant, std::vector<std::uint8_t>& codes) const;
  void write_leaps(std::size_t begin, std::size_t end);

  Index3 bricks_{0};
  std::vector<std::uint32_t> words_;     ///< two a brick
  std::vector<std::uint8_t> leaps_[8];   ///< by octant: one a brick, padded so that eight may be read at the last
  std::vector<std::uint64_t> occupied_;  ///< a bit a brick, rows of whole words
};

/// Bit i of out[i / 32] is set where codes[i] > index; `codes` a multiple of 32.
void pack_bits(std::span<const std::uint8_t> codes, std::uint8_t index, std::uint32_t* out);
/// The same of codes of half a byte, 32 bytes at a time: bits of their lower halves, then of their upper ones.
void pack_half_bits(std::span<const std::uint8_t> codes, std::uint8_t index, std::uint32_t* out);
/// The codes of a row of bricks along x, whose first cell is `first`. \pre at most CellCodes::kMaxThresholds
void code_brick_row(const FieldView& field, const Index3& first, std::span<const float> thresholds,
                    std::uint8_t* codes);

}  // namespace isolux::wide
