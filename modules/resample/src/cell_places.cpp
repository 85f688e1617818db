#include "cell_places.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <cstddef>

#include "fit_texels.h"

namespace isolux {

CellPlaces sort_by_cells(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run) {
  const Index3 size = FitTexels::cells_of(texels);
  const IndexToWorld volume_to_texels = index_to_index(volume.lattice(), texels);
  std::vector<std::size_t> cell_of(sites.size());
  std::vector<CellPlace> unsorted(sites.size());
  parallel_blocks(sites.size(), 65536, run, "", [&](const Block& block) {
    for (std::size_t s = block.begin; s < block.end; ++s) {
      const Vec3 at = volume_to_texels.world(Vec3(sites.positions[s]));
      std::size_t cell = 0;
      for (int a = 2; a >= 0; --a) {
        const double x = std::clamp(at[a], 0.0, double(texels.size[a] - 1));
        const int low = std::min(int(x), size[a] - 1);
        unsorted[s].in_cell[std::size_t(a)] = float(x - low);
        cell = cell * std::size_t(size[a]) + std::size_t(low);
      }
      unsorted[s].site = std::uint32_t(s);
      cell_of[s] = cell;
    }
  });
  CellPlaces sorted;
  sorted.starts.assign(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) + 1, 0);
  for (const std::size_t cell : cell_of) ++sorted.starts[cell + 1];
  for (std::size_t c = 1; c < sorted.starts.size(); ++c) sorted.starts[c] += sorted.starts[c - 1];
  std::vector<std::uint32_t> next(sorted.starts.begin(), sorted.starts.end() - 1);
  sorted.places.resize(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) sorted.places[next[cell_of[s]]++] = unsorted[s];
  return sorted;
}

}  // namespace isolux
