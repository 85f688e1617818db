#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace isolux {

/// The texel that was found for a site. \throw InvalidInput, naming it, if there is none
[[nodiscard]] std::size_t texel_of(const Sites& sites, std::size_t site, const std::optional<std::size_t>& found);

/// The texels that sites are at, in the order of a grid whose axes are those of the texels in another order.
struct LitTexels {
  std::vector<std::uint32_t> at;       ///< of each texel, its number among these, or largest where no site is there
  std::vector<std::uint32_t> of_site;  ///< the number of its texel; empty where each texel has one site at most
  std::vector<std::uint32_t> sites;    ///< the first of each
  std::vector<std::uint32_t> layers;  ///< the number of the first texel of each of the grid's layers; of all at the end

  /// `volume` is what the sites are in; the grid's axis a is the texels' axes[a], the first one its rows'. \throw
  /// InvalidInput for sites that are at no texel
  LitTexels(const Lattice& volume, const Sites& sites, const Lattice& texels, const std::array<int, 3>& axes,
            const Run& run);
};

}  // namespace isolux
