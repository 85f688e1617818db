#include "wide/net_places.h"

#include <algorithm>
#include <cmath>

namespace isolux::wide {
namespace {

constexpr int kLevels = 3;       // of cubes that share a net, each twice as wide as the one below
constexpr int kMostCrowd = 5;    // of 32 sites a cell; any more have nets of their own
constexpr double kAlone = 1.02;  // sites a cell, of those that hold any: a lattice of texels, but for roundings
constexpr int kCoarsest = 10;

struct Cell {
  std::uint32_t x;
  std::uint32_t y;
  std::uint32_t z;
};

Cell cell_of(const Vec3f& position, int cube) {
  const auto index = [cube](float p) { return std::uint32_t(std::max(0.0f, p)) >> cube; };
  return {index(position.x), index(position.y), index(position.z)};
}

/// The lattice of the cells that hold the sites.
struct CellRows {
  Cell end{0, 0, 0};

  CellRows(const Sites& sites, int cube) {
    for (const Vec3f& position : sites.positions) {
      const Cell cell = cell_of(position, cube);
      end = {std::max(end.x, cell.x + 1), std::max(end.y, cell.y + 1), std::max(end.z, cell.z + 1)};
    }
  }
  [[nodiscard]] std::size_t count() const { return std::size_t(end.x) * end.y * end.z; }
  [[nodiscard]] std::size_t offset(const Cell& cell) const {
    return (std::size_t(cell.z) * end.y + cell.y) * end.x + cell.x;
  }
};

/// How many sites share a cell that holds any, on average: a bit a cell.
double sites_a_cell(const Sites& sites, int cube) {
  const CellRows rows(sites, cube);
  std::vector<bool> holds_any(rows.count());
  std::size_t cells = 0;
  for (const Vec3f& position : sites.positions) {
    const std::size_t cell = rows.offset(cell_of(position, cube));
    cells += std::size_t(!holds_any[cell]);
    holds_any[cell] = true;
  }
  return cells == 0 ? 0.0 : double(sites.size()) / double(cells);
}

/// The number of each site among those of its cell, from 0 and up to 255: a byte a cell while it lasts.
std::vector<std::uint8_t> number_in_cells(const Sites& sites, int cube) {
  const CellRows rows(sites, cube);
  std::vector<std::uint8_t> counts(rows.count());
  std::vector<std::uint8_t> orders(sites.size());
  for (std::size_t site = 0; site < sites.size(); ++site) {
    std::uint8_t& count = counts[rows.offset(cell_of(sites.positions[site], cube))];
    orders[site] = count;
    if (count < 255) ++count;
  }
  return orders;
}

}  // namespace

NetPlaces::NetPlaces(const Sites& sites) {
  const double shared = sites_a_cell(sites, 0);
  if (shared > kAlone) {
    crowd_ = std::clamp(int(std::lround(std::log2(shared))), 0, kMostCrowd);
    orders_ = number_in_cells(sites, 0);
    return;
  }
  while (cube_ < kCoarsest && sites_a_cell(sites, cube_ + 1) <= kAlone) ++cube_;
}

NetPlaces::Place NetPlaces::of(const Sites& sites, std::size_t site) const {
  const Cell cell = cell_of(sites.positions[site], cube_);
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
