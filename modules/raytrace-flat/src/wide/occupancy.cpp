#include "wide/occupancy.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace isolux::wide {
namespace {

constexpr std::size_t kBrickCells = 64;
/// Longer leaps are rare and a level more costs a pass over the bricks.
constexpr int kMaxDistance = 24;

Index3 brick_count(Index3 points) { return (points - 1 + (kBrick - 1)) / kBrick; }

/// Largest values of a brick's cells, from its up to 5 x 5 x 5 grid points.
struct BrickMaxima {
  float value[kBrickCells];
  Index3 cells{0};  ///< how many of the brick's cells there are on each axis

  BrickMaxima(const FieldView& field, Index3 brick) {
    const float sign = field.outer == OuterSide::kLower ? 1.0f : -1.0f;
    const Index3 first = brick * kBrick;
    for (int a = 0; a < 3; ++a) cells[a] = std::min(kBrick, field.size[a] - 1 - first[a]);
    float point[5][5][5];
    for (int k = 0; k <= cells.z; ++k) {
      for (int j = 0; j <= cells.y; ++j) {
        const std::size_t row = (std::size_t(first.z + k) * std::size_t(field.size.y) + std::size_t(first.y + j)) *
                                    std::size_t(field.size.x) +
                                std::size_t(first.x);
        for (int i = 0; i <= cells.x; ++i) point[k][j][i] = sign * field.values[row + std::size_t(i)];
        for (int i = 0; i < cells.x; ++i) point[k][j][i] = std::max(point[k][j][i], point[k][j][i + 1]);
      }
    }
    for (int k = 0; k < cells.z; ++k) {
      for (int j = 0; j < cells.y; ++j) {
        for (int i = 0; i < cells.x; ++i) {
          value[k * 16 + j * 4 + i] = std::max(std::max(point[k][j][i], point[k][j + 1][i]),
                                               std::max(point[k + 1][j][i], point[k + 1][j + 1][i]));
        }
      }
    }
  }
};

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

/// to |= from, shifted by one bit in both directions along rows of `row` words.
void widen_rows(const std::vector<std::uint64_t>& from, std::size_t row, std::vector<std::uint64_t>& to) {
  for (std::size_t begin = 0; begin < from.size(); begin += row) {
    for (std::size_t w = 0; w < row; ++w) {
      const std::uint64_t here = from[begin + w];
      std::uint64_t wide = here | here << 1 | here >> 1;
      if (w > 0) wide |= from[begin + w - 1] >> 63;
      if (w + 1 < row) wide |= from[begin + w + 1] << 63;
      to[begin + w] = wide;
    }
  }
}

/// to = from, widened by one step of `stride` words in both directions within groups of `group` words.
void widen_planes(const std::vector<std::uint64_t>& from, std::size_t stride, std::size_t group,
                  std::vector<std::uint64_t>& to) {
  for (std::size_t begin = 0; begin < from.size(); begin += group) {
    for (std::size_t w = begin; w < begin + group; ++w) {
      std::uint64_t wide = from[w];
      if (w >= begin + stride) wide |= from[w - stride];
      if (w + stride < begin + group) wide |= from[w + stride];
      to[w] = wide;
    }
  }
}

}  // namespace

CellCodes::CellCodes(const FieldView& field, std::span<const float> thresholds, const Run& run)
    : bricks_(brick_count(field.size)),
      codes_(std::size_t(bricks_.x) * std::size_t(bricks_.y) * std::size_t(bricks_.z) * kBrickCells, 0) {
  const auto layer = std::size_t(bricks_.x) * std::size_t(bricks_.y);
  parallel_blocks(std::size_t(bricks_.z), 1, run, "", [&](const Block& block) {
    std::uint8_t* out = codes_.data() + block.begin * layer * kBrickCells;
    for (int j = 0; j < bricks_.y; ++j) {
      for (int i = 0; i < bricks_.x; ++i, out += kBrickCells) {
        const BrickMaxima maxima(field, {i, j, int(block.begin)});
        for (int z = 0; z < maxima.cells.z; ++z) {
          for (int y = 0; y < maxima.cells.y; ++y) {
            for (int x = 0; x < maxima.cells.x; ++x) {
              const int cell = z * 16 + y * 4 + x;
              const auto reached = std::upper_bound(thresholds.begin(), thresholds.end(), maxima.value[cell]);
              out[cell] = std::uint8_t(reached - thresholds.begin());
            }
          }
        }
      }
    }
  });
}

Occupancy::Occupancy(const CellCodes& codes) : bricks_(codes.bricks()) {
  const std::size_t count = codes.codes().size() / kBrickCells;
  const std::size_t row = (std::size_t(bricks_.x) + 63) / 64;
  words_.resize(2 * count);
  distance_.resize(count + 8);
  near_.resize(row * std::size_t(bricks_.y) * std::size_t(bricks_.z));
  widened_.resize(near_.size());
}

void Occupancy::build(const CellCodes& codes, int index, const Run& run) {
  constexpr std::size_t kBricksABlock = 8192;
  const std::span<const std::uint8_t> bytes = codes.codes();
  parallel_blocks(bytes.size() / kBrickCells, kBricksABlock, run, "", [&](const Block& block) {
    pack_bits(bytes.subspan(block.begin * kBrickCells, (block.end - block.begin) * kBrickCells), std::uint8_t(index),
              words_.data() + 2 * block.begin);
  });
  build_distances();
}

void Occupancy::build_distances() {
  static const std::array<std::uint64_t, 256> spread = make_spread();
  const auto nx = std::size_t(bricks_.x);
  const std::size_t rows = std::size_t(bricks_.y) * std::size_t(bricks_.z);
  const std::size_t row = (nx + 63) / 64;
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t w = 0; w < row; ++w) {
      std::uint64_t bits = 0;
      for (std::size_t i = 64 * w; i < std::min(nx, 64 * w + 64); ++i) {
        const std::uint32_t* word = words_.data() + 2 * (r * nx + i);
        bits |= std::uint64_t((word[0] | word[1]) != 0) << (i & 63);
      }
      near_[r * row + w] = bits;
    }
  }
  std::fill(distance_.begin(), distance_.end(), std::uint8_t(0));
  for (int d = 1; d <= kMaxDistance; ++d) {
    bool any_far = false;
    for (std::size_t r = 0; r < rows; ++r) {
      std::uint8_t* out = distance_.data() + r * nx;
      for (std::size_t i = 0; i < nx; i += 8) {
        // What lies beyond the row's end belongs to the next row.
        const auto valid = std::uint8_t(nx - i >= 8 ? 0xFF : 0xFF >> (8 - (nx - i)));
        const auto far = std::uint8_t(~(near_[r * row + i / 64] >> (i & 63)) & valid);
        if (far == 0) continue;
        any_far = true;
        std::uint64_t sum = 0;
        std::memcpy(&sum, out + i, 8);
        sum += spread[far];  // no byte reaches 256, so nothing is carried
        std::memcpy(out + i, &sum, 8);
      }
    }
    if (!any_far) break;
    widen_rows(near_, row, widened_);
    widen_planes(widened_, row, row * std::size_t(bricks_.y), near_);
    widen_planes(near_, row * std::size_t(bricks_.y), near_.size(), widened_);
    near_.swap(widened_);
  }
  for (std::size_t b = 0; b < nx * rows; ++b) {
    for (std::uint32_t* word : {&words_[2 * b], &words_[2 * b + 1]}) {
      if (*word != 0) *word |= 1u << 31;
      if (distance_[b] > 0) *word = distance_[b];
    }
  }
}

}  // namespace isolux::wide
