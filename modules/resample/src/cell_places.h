#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <array>
#include <cstdint>
#include <vector>

namespace isolux {

/// Where a site lies between the texel centres around it.
struct CellPlace {
  std::array<float, 3> in_cell;  ///< 0 at the lower texel centres, 1 at the upper ones
  std::uint32_t site;
};

/// Sites by the cell of texel centres that holds them, x fastest, those of a cell in their own order.
struct CellPlaces {
  std::vector<std::uint32_t> starts;  ///< of each cell's places, and the end
  std::vector<CellPlace> places;
};

/// Beyond the outermost texel centres places are clamped, as reading is.
[[nodiscard]] CellPlaces sort_by_cells(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run);

}  // namespace isolux
