#include "wide/inner.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <bit>

#include "wide/level_rank.h"
#include "wide/occupancy.h"

namespace isolux::wide {
namespace {

constexpr int kCube = 2;
constexpr int kCubesAWord = 32;

/// Smallest values at each x of the grid points that a row of cubes touches.
void row_minima(const FieldView& field, int j, int k, std::vector<float>& smallest) {
  const auto nx = std::size_t(field.size.x);
  const auto ny = std::size_t(field.size.y);
  const float sign = field.outer == OuterSide::kLower ? 1.0f : -1.0f;
  std::fill(smallest.begin(), smallest.end(), std::numeric_limits<float>::infinity());
  for (int z = kCube * k; z <= kCube * (k + 1); ++z) {
    for (int y = kCube * j; y <= kCube * (j + 1); ++y) {
      const float* row = field.values + (std::size_t(z) * ny + std::size_t(y)) * nx;
      for (std::size_t i = 0; i < nx; ++i) smallest[i] = std::min(smallest[i], sign * row[i]);
    }
  }
}

}  // namespace

InnerCodes::InnerCodes(const FieldView& field, std::span<const float> ceilings, const Run& run)
    : cubes_((field.size - 1) / kCube) {
  const int used = cubes_.x;
  cubes_.x = (used + kCubesAWord - 1) / kCubesAWord * kCubesAWord;
  const LevelRank rank(ceilings);
  const std::size_t layer = std::size_t(cubes_.x) * std::size_t(cubes_.y);
  codes_.resize(layer * std::size_t(cubes_.z), 0);
  parallel_blocks(std::size_t(cubes_.z), 1, run, "", [&](const Block& block) {
    std::vector<float> smallest(std::size_t(field.size.x));
    for (int j = 0; j < cubes_.y; ++j) {
      row_minima(field, j, int(block.begin), smallest);
      std::uint8_t* out = codes_.data() + block.begin * layer + std::size_t(j) * std::size_t(cubes_.x);
      for (int i = 0; i < used; ++i) {
        const auto first = smallest.begin() + kCube * i;
        const float least = *std::min_element(first, first + kCube + 1);
        out[i] = std::uint8_t(rank.exceeded(least));
      }
    }
  });
}

InnerCubes::InnerCubes(const InnerCodes& codes) : cubes_(codes.cubes()), bits_(codes.codes().size() / kCubesAWord) {}

void InnerCubes::build(const InnerCodes& codes, int index, const Run& run) {
  constexpr std::size_t kWordsABlock = 16384;
  constexpr std::size_t kFewest = 256;  // one of so many
  const std::span<const std::uint8_t> bytes = codes.codes();
  parallel_blocks(bits_.size(), kWordsABlock, run, "", [&](const Block& block) {
    const std::size_t words = block.end - block.begin;
    pack_bits(bytes.subspan(block.begin * kCubesAWord, words * kCubesAWord), std::uint8_t(index),
              bits_.data() + block.begin);
  });
  std::size_t count = 0;
  for (const std::uint32_t word : bits_) count += std::size_t(std::popcount(word));
  is_worth_it_ = kFewest * count > bytes.size();
}

}  // namespace isolux::wide
