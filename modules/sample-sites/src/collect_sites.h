#pragma once

#include <isolux/sample_sites/site_sampler.h>

#include <cstdint>
#include <functional>

#include "active_cells.h"

namespace isolux {

/// Point number i of an endless sequence in [0,1)^3.
using UnitSequence = std::function<Vec3(std::uint64_t i)>;

/// Where every scattering sampler gives up on a site: so many candidates were tried for each one wanted.
inline constexpr std::uint64_t kCandidatesPerSite = 1024;

/// The number of sites a request asks for; its 0 means `per_texel` for each texel of the active part of the box.
[[nodiscard]] std::size_t wanted_sites(const SiteRequest& request, const ActiveCells& cells);

/// The first `count` points of the sequence that, placed in the active cells, are sites; fewer where kCandidatesPerSite
/// is reached. A prefix of a sequence is as even as the sequence, so rejection costs nothing but time.
[[nodiscard]] Sites collect_sites(const Volume& volume, const SiteRequest& request, const ActiveCells& cells,
                                  std::size_t count, const UnitSequence& sequence, const Run& run);

/// Points [first, last) of the sequence placed in the active cells, without those that are no sites.
[[nodiscard]] Sites sites_of_range(const Volume& volume, const SiteRequest& request, const ActiveCells& cells,
                                   std::uint64_t first, std::uint64_t last, const UnitSequence& sequence,
                                   const Run& run);

/// None yet, and room for so many: growing bit by bit would copy them, and clear memory for them, several times.
[[nodiscard]] Sites room_for_sites(std::size_t count);
/// Appends the first `count` of `more`, or all if there are fewer.
void append_sites(Sites& all, const Sites& more, std::size_t count);

}  // namespace isolux
