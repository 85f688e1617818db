#include "site_figures.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cstdint>

namespace isolux {

void count_sites(const Volume& volume, const SiteRequest& request, const BakeSettings& settings, BakeResult& result) {
  if (result.sites == 0)
    throw InvalidInput(fmt::format("{}: no site has a normal and an isovalue in the range", volume.name));
  if (settings.sampler.name != "texels") return;
  const std::uint64_t left_out = request.texels.count() - result.sites;
  const std::uint64_t outside = request.only != nullptr ? request.texels.count() - request.only->count() : 0;
  result.skipped["sites_outside_iso_range"] = outside;
  result.skipped["sites_flat"] = left_out - std::min(left_out, outside);
}

}  // namespace isolux
