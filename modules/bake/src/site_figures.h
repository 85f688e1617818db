#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// Says of sites at texels why others are none, in result.skipped. \pre result.sites \throw InvalidInput if there are
/// none at all
void count_sites(const Volume& volume, const SiteRequest& request, const BakeSettings& settings, BakeResult& result);

}  // namespace isolux
