#include "active_words.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <numeric>

namespace isolux::mc {

void ActiveWords::find(const BrickIndex& index, const ExtractSettings& settings, const Run& run, int words) {
  words_ = words;
  rows_ = index.rows();
  const std::size_t rows = std::size_t(index.rows()) * std::size_t(index.layers());
  bricks_.assign(rows * std::size_t(words), 0);
  active_rows_.assign(rows, 0);
  constexpr std::size_t kLayers = 16;  // a task's
  std::vector<std::size_t> found(block_count(std::size_t(index.layers()), kLayers), 0);
  parallel_blocks(std::size_t(index.layers()), kLayers, run, "", [&](const Block& block) {
    for (int layer = int(block.begin); layer < int(block.end); ++layer) {
      if (!index.layer_is_mixed(settings, layer)) continue;
      for (int row = 0; row < index.rows(); ++row) {
        const int count = index.find_active(settings, row, layer, &bricks_[at(row, layer) * std::size_t(words)]);
        active_rows_[at(row, layer)] = std::uint8_t(count > 0);
        found[block.index] += std::size_t(count);
      }
    }
  });
  const std::size_t all = std::accumulate(found.begin(), found.end(), std::size_t(0));
  share_ = double(all) / double(rows * std::size_t(index.bricks_in_row()));
}

}  // namespace isolux::mc
