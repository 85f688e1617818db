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

/// Where sites saw what.
class Surroundings {
 public:
  Surroundings(const wide::SiteCells& cells, const Sites& sites, std::span<const LampSeen> seen)
      : any_(cells.end()),
        all_(cells.end()),
        none_(cells.end()),
        some_(cells.end()),
        near_some_(cells.end()),
        several_(cells.end()) {
    for (std::size_t site = 0; site < seen.size(); ++site) {
      const wide::SiteCells::Cell cell = cells.of(sites.positions[site]);
      const bool some = seen[site] == LampSeen::kSome;
      const bool all = seen[site] == LampSeen::kAll;
      const bool none = seen[site] == LampSeen::kNone;
      if (all || some || none) any_.set(cell);
      if (all) all_.set(cell);
      if (none) none_.set(cell);
      if (some && some_[cell]) several_.set(cell);
      if (some) some_.set(cell);
    }
    all_.dilate();
    none_.dilate();
    near_some_ = some_;
    near_some_.dilate();
  }

  [[nodiscard]] bool are_few(const wide::SiteCells::Cell& cell) const { return any_.count_about(cell) < kLeastCells; }
  [[nodiscard]] bool are_on_both_sides(const wide::SiteCells::Cell& cell) const { return all_[cell] && none_[cell]; }
  [[nodiscard]] bool hold_an_edge(const wide::SiteCells::Cell& cell) const {
    return near_some_[cell] || are_on_both_sides(cell) || are_few(cell);
  }
  /// But for one site in the cell that saw a part.
  [[nodiscard]] bool agree(const wide::SiteCells::Cell& cell) const {
    return !several_[cell] && some_.count_about(cell) == 1 && !are_on_both_sides(cell) && !are_few(cell);
  }

 private:
  wide::CellBits any_;   ///< cells
  wide::CellBits all_;   ///< and the cells about them
  wide::CellBits none_;  ///< likewise
  wide::CellBits some_;
  wide::CellBits near_some_;
  wide::CellBits several_;  ///< that saw a part
};

}  // namespace

ShadowEdges find_shadow_edges(const Sites& sites, std::span<const LampSeen> seen) {
  const wide::SiteCells cells = cells_for(sites);
  const Surroundings about(cells, sites, seen);
  ShadowEdges result{.near = std::vector<bool>(seen.size()), .alone = {}};
  for (std::size_t site = 0; site < seen.size(); ++site) {
    if (seen[site] == LampSeen::kTurnedAway) continue;
    const wide::SiteCells::Cell cell = cells.of(sites.positions[site]);
    result.near[site] = seen[site] == LampSeen::kRising || about.hold_an_edge(cell);
    if (seen[site] == LampSeen::kSome && about.agree(cell)) result.alone.push_back(std::uint32_t(site));
  }
  return result;
}

}  // namespace isolux
