#include "brick_index.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <limits>

#include "wide_kernels.h"

namespace isolux::mc {

BrickIndex::BrickIndex(const VolumeView& volume, const Run& run) {
  const Index3 size = volume.lattice().size;
  bricks_ = {(size.x + kWidth - 1) / kWidth, (size.y + kHeight - 1) / kHeight, (size.z + kHeight - 1) / kHeight};
  const std::size_t rows = std::size_t(bricks_.y) * bricks_.z;
  low_.resize(rows * bricks_.x);
  high_.resize(rows * bricks_.x);
  row_low_.resize(rows);
  row_high_.resize(rows);
  parallel_blocks(rows, std::size_t(bricks_.y), run, "index", [&](const Block& block) {
    for (std::size_t n = block.begin; n < block.end; ++n) {
      const int row = int(n % bricks_.y);
      const int layer = int(n / bricks_.y);
      float* low = &low_[n * bricks_.x];
      float* high = &high_[n * bricks_.x];
      for (int brick = 0; brick < bricks_.x; ++brick) {
        const Index3 first(brick * kWidth, row * kHeight, layer * kHeight);
        const Index3 last = glm::min(first + Index3(kWidth, kHeight, kHeight), size - 1);
        find_range(volume, first, last, low[brick], high[brick]);
      }
      row_low_[n] = *std::min_element(low, low + bricks_.x);
      row_high_[n] = *std::max_element(high, high + bricks_.x);
    }
  });
  for (int layer = 0; layer < bricks_.z; ++layer) {
    const auto first = std::ptrdiff_t(row_number(0, layer));
    layer_low_.push_back(*std::min_element(row_low_.begin() + first, row_low_.begin() + first + bricks_.y));
    layer_high_.push_back(*std::max_element(row_high_.begin() + first, row_high_.begin() + first + bricks_.y));
  }
}

namespace {
bool is_mixed(const ExtractSettings& settings, float low, float high) {
  return settings.outer == OuterSide::kLower ? low < settings.isovalue && high >= settings.isovalue
                                             : low <= settings.isovalue && high > settings.isovalue;
}
}  // namespace

bool BrickIndex::layer_is_mixed(const ExtractSettings& settings, int layer) const {
  return is_mixed(settings, layer_low_[layer], layer_high_[layer]);
}

int BrickIndex::find_active(const ExtractSettings& settings, int row, int layer, std::uint8_t* activity) const {
  const std::size_t n = row_number(row, layer);
  if (!is_mixed(settings, row_low_[n], row_high_[n])) return 0;
  const float* low = &low_[n * bricks_.x];
  const float* high = &high_[n * bricks_.x];
  int count = 0;
  for (int brick = 0; brick < bricks_.x; ++brick) {
    const int mixed = int(is_mixed(settings, low[brick], high[brick]));
    activity[brick / kBricksPerWord] |= std::uint8_t(mixed << brick % kBricksPerWord);
    count += mixed;
  }
  return count;
}

bool BrickIndex::inside(const ExtractSettings& settings, int brick, int row, int layer) const {
  const float value = low_[row_number(row, layer) * bricks_.x + brick];
  return settings.outer == OuterSide::kLower ? value >= settings.isovalue : value <= settings.isovalue;
}

}  // namespace isolux::mc
