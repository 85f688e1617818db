#include "wide/occupancy.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace isolux::wide {
namespace {

constexpr std::size_t kBrickBytes = 32;  // of codes
/// A leap's code c stands for this many bricks, as kernels compute it: c + 1 + max(0, c - 3).
constexpr int kLeapOfCode[8] = {1, 2, 3, 4, 6, 8, 10, 12};

Index3 brick_count(Index3 points) { return (points - 1 + (kBrick - 1)) / kBrick; }

/// Eight bits to eight bytes of 0 or 1, the lowest bit to the lowest address.
std::array<std::uint64_t, 256> make_spread() {
  std::array<std::uint64_t, 256> table{};
  for (std::size_t bits = 0; bits < 256; ++bits) {
    std::uint8_t bytes[8];
    for (std::size_t i = 0; i < 8; ++i) bytes[i] = std::uint8_t(bits >> i & 1);
    std::memcpy(&table[bits], bytes, 8);
  }
  return table;
}

/// A bit a brick, rows of whole words: where a cube of bricks that reaches into one octant meets an occupied one.
class Obstacles {
 public:
  Obstacles(const std::vector<std::uint64_t>& occupied, std::size_t row, std::size_t rows_y, unsigned octant)
      : bits_(occupied), row_(row), layer_(row * rows_y), octant_(octant) {}

  [[nodiscard]] std::span<const std::uint64_t> bits() const { return bits_; }

  /// Makes the cubes a brick larger.
  void grow() {
    for (std::size_t begin = 0; begin < bits_.size(); begin += row_) grow_row(bits_.data() + begin);
    for (std::size_t begin = 0; begin < bits_.size(); begin += layer_)
      grow_planes(bits_.data() + begin, layer_, row_, (octant_ & 2u) != 0);
    grow_planes(bits_.data(), bits_.size(), layer_, (octant_ & 4u) != 0);
  }

 private:
  void grow_row(std::uint64_t* words) const {
    if ((octant_ & 1u) != 0) {
      for (std::size_t w = row_; w-- > 0;) words[w] |= words[w] << 1 | (w > 0 ? words[w - 1] >> 63 : 0);
    } else {
      for (std::size_t w = 0; w < row_; ++w) words[w] |= words[w] >> 1 | (w + 1 < row_ ? words[w + 1] << 63 : 0);
    }
  }

  /// In place, each word before its neighbour changes.
  static void grow_planes(std::uint64_t* words, std::size_t count, std::size_t stride, bool backwards) {
    if (backwards) {
      for (std::size_t w = count; w-- > stride;) words[w] |= words[w - stride];
    } else {
      for (std::size_t w = 0; w + stride < count; ++w) words[w] |= words[w + stride];
    }
  }

  std::vector<std::uint64_t> bits_;
  std::size_t row_;
  std::size_t layer_;
  unsigned octant_;
};

}  // namespace

CellCodes::CellCodes(const FieldView& field)
    : field_(field),
      bricks_(brick_count(field.size)),
      codes_(std::size_t(bricks_.x) * std::size_t(bricks_.y) * std::size_t(bricks_.z) * kBrickBytes) {}

void CellCodes::build(std::span<const float> thresholds, const Run& run) {
  const std::size_t row = std::size_t(bricks_.x) * kBrickBytes;
  const std::size_t layer = row * std::size_t(bricks_.y);
  parallel_blocks(std::size_t(bricks_.z), 1, run, "", [&](const Block& block) {
    for (int y = 0; y < bricks_.y; ++y) {
      const Index3 first(0, y * kBrick, int(block.begin) * kBrick);
      code_brick_row(field_, first, thresholds, codes_.data() + block.begin * layer + std::size_t(y) * row);
    }
  });
}

Occupancy::Occupancy(const CellCodes& codes) : bricks_(codes.bricks()) {
  const std::size_t count = codes.codes().size() / kBrickBytes;
  words_.resize(2 * count);
  for (auto& octant : leaps_) octant.resize(count + 8);
  const std::size_t row = (std::size_t(bricks_.x) + 63) / 64;
  occupied_.resize(row * std::size_t(bricks_.y) * std::size_t(bricks_.z));
}

void Occupancy::build(const CellCodes& codes, int index, const Run& run) {
  constexpr std::size_t kBricksABlock = 8192;
  const std::span<const std::uint8_t> bytes = codes.codes();
  parallel_blocks(bytes.size() / kBrickBytes, kBricksABlock, run, "", [&](const Block& block) {
    pack_half_bits(bytes.subspan(block.begin * kBrickBytes, (block.end - block.begin) * kBrickBytes),
                   std::uint8_t(index), words_.data() + 2 * block.begin);
  });
  find_occupied();
  parallel_blocks(std::size(leaps_), 1, run, "",
                  [&](const Block& block) { measure_leaps(unsigned(block.begin), leaps_[block.begin]); });
  parallel_blocks(words_.size() / 2, kBricksABlock, run, "",
                  [&](const Block& block) { write_leaps(block.begin, block.end); });
}

void Occupancy::find_occupied() {
  const auto nx = std::size_t(bricks_.x);
  const std::size_t row = (nx + 63) / 64;
  for (std::size_t r = 0; r < occupied_.size() / row; ++r) {
    for (std::size_t w = 0; w < row; ++w) {
      std::uint64_t bits = 0;
      for (std::size_t i = 64 * w; i < std::min(nx, 64 * w + 64); ++i) {
        const std::uint32_t* word = words_.data() + 2 * (r * nx + i);
        bits |= std::uint64_t((word[0] | word[1]) != 0) << (i & 63);
      }
      occupied_[r * row + w] = bits;
    }
  }
}

void Occupancy::measure_leaps(unsigned octant, std::vector<std::uint8_t>& codes) const {
  static const std::array<std::uint64_t, 256> spread = make_spread();
  const auto nx = std::size_t(bricks_.x);
  const std::size_t row = (nx + 63) / 64;
  const std::size_t rows = occupied_.size() / row;
  Obstacles obstacles(occupied_, row, std::size_t(bricks_.y), octant);
  std::fill(codes.begin(), codes.end(), std::uint8_t(0));
  for (int code = 1; code < 8; ++code) {
    for (int step = kLeapOfCode[code - 1]; step < kLeapOfCode[code]; ++step) obstacles.grow();
    bool any_free = false;
    for (std::size_t r = 0; r < rows; ++r) {
      std::uint8_t* out = codes.data() + r * nx;
      for (std::size_t i = 0; i < nx; i += 8) {
        // What lies beyond the row's end belongs to the next row.
        const auto valid = std::uint8_t(nx - i >= 8 ? 0xFF : 0xFF >> (8 - (nx - i)));
        const auto free = std::uint8_t(~(obstacles.bits()[r * row + i / 64] >> (i & 63)) & valid);
        if (free == 0) continue;
        any_free = true;
        std::uint64_t sum = 0;
        std::memcpy(&sum, out + i, 8);
        sum += spread[free];  // no byte reaches 256, so nothing is carried
        std::memcpy(out + i, &sum, 8);
      }
    }
    if (!any_free) break;
  }
}

void Occupancy::write_leaps(std::size_t begin, std::size_t end) {
  for (std::size_t b = begin; b < end; ++b) {
    std::uint32_t* word = words_.data() + 2 * b;
    if ((word[0] | word[1]) == 0) {
      std::uint32_t leaps = kEmptyBrick;
      for (unsigned octant = 0; octant < 8; ++octant) leaps |= std::uint32_t(leaps_[octant][b]) << (3 * octant);
      word[0] = word[1] = leaps;
    } else {
      for (int half = 0; half < 2; ++half)
        if ((word[half] & kUpperByte) == kEmptyBrick) word[half] |= 1u << 24;
    }
  }
}

}  // namespace isolux::wide
