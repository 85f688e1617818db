#pragma once

#include <isolux/core/sample_set.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "wide/site_cells.h"

namespace isolux::wide {

/// Which part of a larger net each site's rays are, so that the rays of sites close together are one net as well: means
/// over neighbours (a fit, a filter, the trilinear reading) then lose noise faster than with independent nets. Sites of
/// aligned cubes of 2, 4 and 8 cells share nets of 8, 64 and 512 times the rays; the cubes of 8 are independent of each
/// other. The same idea over pixels: Ahmed & Wonka, "Screen-space blue-noise diffusion of Monte Carlo sampling error
/// via hierarchical ordering of pixels" (SIGGRAPH Asia 2020). Immutable.
class NetPlaces {
 public:
  /// Finds how densely the sites lie: a few passes, a bit a cell while they last; where sites share cells a byte a
  /// cell, and a byte a site.
  explicit NetPlaces(const Sites& sites);

  struct Place {
    std::uint64_t net;   ///< sites of equal `net` share one
    std::uint32_t part;  ///< which part of it
  };
  [[nodiscard]] Place of(const Sites& sites, std::size_t site) const;

 private:
  SiteCells cells_;
  int crowd_ = 0;                     ///< log2 of how many sites share a cell
  std::vector<std::uint8_t> orders_;  ///< of each site among those of its cell; empty: it has none beside it
};

}  // namespace isolux::wide
