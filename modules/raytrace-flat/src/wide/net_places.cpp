#include "wide/net_places.h"

#include <algorithm>
#include <cmath>

namespace isolux::wide {
namespace {

constexpr int kLevels = 3;     // of cubes that share a net, each twice as wide as the one below
constexpr int kMostCrowd = 5;  // of 32 sites a cell; any more have nets of their own
/// The number of each site among those of its cell, from 0 and up to 255: a byte a cell while it lasts.
std::vector<std::uint8_t> number_in_cells(const Sites& sites, const SiteCells& cells) {
  const SiteCells::Cell& end = cells.end();
  std::vector<std::uint8_t> counts(std::size_t(end.x) * end.y * end.z);
  std::vector<std::uint8_t> orders(sites.size());
  for (std::size_t site = 0; site < sites.size(); ++site) {
    const SiteCells::Cell cell = cells.of(sites.positions[site]);
    std::uint8_t& count = counts[(std::size_t(cell.z) * end.y + cell.y) * end.x + cell.x];
    orders[site] = count;
    if (count < 255) ++count;
  }
  return orders;
}

}  // namespace

NetPlaces::NetPlaces(const Sites& sites) : cells_(sites, 0) {
  const double shared = HeldCells(sites, 0).sites_a_cell;
  if (shared > SiteCells::kAlone) {
    crowd_ = std::clamp(int(std::lround(std::log2(shared))), 0, kMostCrowd);
    orders_ = number_in_cells(sites, cells_);
    return;
  }
  for (int n = 1; n <= SiteCells::kLargest; ++n) {
    const HeldCells held(sites, n);
    if (held.sites_a_cell > SiteCells::kAlone) return;
    cells_ = held.cells;
  }
}

NetPlaces::Place NetPlaces::of(const Sites& sites, std::size_t site) const {
  const SiteCells::Cell cell = cells_.of(sites.positions[site]);
  Place place{.net = (std::uint64_t(cell.z >> kLevels) << 21 | (cell.y >> kLevels)) << 21 | (cell.x >> kLevels),
              .part = 0};
  const std::uint32_t order = orders_.empty() ? 0 : orders_[site];
  if (order >> crowd_ != 0) {
    place.net = ~std::uint64_t(site);
    return place;
  }
  place.part = order;
  for (int level = 0; level < kLevels; ++level) {
    // Neighbours along any one axis, and across any edge, then differ in the first or second halving of what is left:
    // far apart. The plain bits would leave neighbours along z nearly alike.
    const std::uint32_t x = cell.x >> level & 1;
    const std::uint32_t y = cell.y >> level & 1;
    const std::uint32_t z = cell.z >> level & 1;
    place.part |= ((x ^ y) | (y ^ z) << 1 | z << 2) << (crowd_ + 3 * level);
  }
  return place;
}

}  // namespace isolux::wide
