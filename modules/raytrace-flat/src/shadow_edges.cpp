#include "shadow_edges.h"

#include <algorithm>
#include <cstddef>

#include "wide/site_cells.h"

namespace isolux {
namespace {

constexpr double kSitesAbout = 20.0;  // in a cell and the 26 about it
constexpr int kLeastCells = 8;        // of those, that hold a site: all in a corner of a box of them
constexpr std::size_t kSamples = 4096;

/// The smallest cells with enough sites about a site.
wide::SiteCells cells_for(const Sites& sites) {
  const std::size_t step = std::max<std::size_t>(1, sites.size() / kSamples);
  for (int n = 0;; ++n) {
    const wide::HeldCells held(sites, n);
    double cells = 0.0;
    double samples = 0.0;
    for (std::size_t site = 0; site < sites.size(); site += step) {
      cells += double(held.bits.count_about(held.cells.of(sites.positions[site])));
      samples += 1.0;
    }
    if (n == wide::SiteCells::kLargest || held.sites_a_cell * cells >= kSitesAbout * samples) return held.cells;
  }
}

}  // namespace

std::vector<bool> near_shadow_edges(const Sites& sites, std::span<const LampSeen> seen) {
  const wide::SiteCells cells = cells_for(sites);
  wide::CellBits any(cells.end());
  wide::CellBits lit(cells.end());
  wide::CellBits dark(cells.end());
  for (std::size_t site = 0; site < seen.size(); ++site) {
    const bool some = seen[site] == LampSeen::kSome;
    const bool all = seen[site] == LampSeen::kAll;
    const bool none = seen[site] == LampSeen::kNone;
    const wide::SiteCells::Cell cell = cells.of(sites.positions[site]);
    if (all || some || none) any.set(cell);
    if (all || some) lit.set(cell);
    if (none || some) dark.set(cell);
  }
  lit.dilate();
  dark.dilate();
  std::vector<bool> near(seen.size());
  for (std::size_t site = 0; site < seen.size(); ++site) {
    if (seen[site] == LampSeen::kTurnedAway) continue;
    const wide::SiteCells::Cell cell = cells.of(sites.positions[site]);
    near[site] = seen[site] == LampSeen::kRising || (lit[cell] && dark[cell]) || any.count_about(cell) < kLeastCells;
  }
  return near;
}

}  // namespace isolux
