#include "cell_places.h"

#include <isolux/core/parallel.h>

#include <glm/common.hpp>
#include <memory>

namespace isolux {

TexelCells::TexelCells(const Lattice& volume, const Lattice& texels)
    : volume_to_texels_(index_to_index(volume, texels)),
      last_(texels.size - 1),
      size_(glm::max(texels.size - 1, Index3(1))) {}

CellOrder sort_by_cells(const TexelCells& cells, const Sites& sites, const Run& run) {
  CellOrder order;
  const Index3& size = cells.size();
  order.starts.assign(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) + 1, 0);
  const auto cell_of = std::make_unique_for_overwrite<std::size_t[]>(sites.size());
  parallel_blocks(sites.size(), 65536, run, "", [&](const Block& block) {
    for (std::size_t s = block.begin; s < block.end; ++s) cell_of[s] = cells.place(sites.positions[s]).cell;
  });
  for (std::size_t s = 0; s < sites.size(); ++s) ++order.starts[cell_of[s] + 1];
  for (std::size_t c = 1; c < order.starts.size(); ++c) order.starts[c] += order.starts[c - 1];
  std::vector<std::uint32_t> next(order.starts.begin(), order.starts.end() - 1);
  order.sites.resize(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) order.sites[next[cell_of[s]]++] = std::uint32_t(s);
  return order;
}

}  // namespace isolux
