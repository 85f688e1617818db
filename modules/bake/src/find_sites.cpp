#include <isolux/bake/find_sites.h>
#include <isolux/core/stopwatch.h>

#include "bake_parts.h"
#include "checked_stages.h"
#include "resampling_choice.h"
#include "site_figures.h"

namespace isolux {

FoundSites find_sites(const Volume& volume, OuterSide outer, const BakeSettings& settings, const Stages& stages,
                      const Run& run) {
  require_lightable(volume, settings);
  const auto sampler = checked_sampler(settings.sampler, stages);
  const Lattice texels = texel_lattice(volume.lattice(), settings);
  const Stopwatch watch;
  SiteRequest request = site_request(volume, settings, texels, outer, run);
  request.per_texel = sites_a_texel(volume.lattice(), texels, settings);
  FoundSites found;
  BakeResult& result = found.begun;
  found.sites = sampler->sample(volume, request, run);
  result.sites = found.sites.size();
  count_sites(volume, request, settings, result);
  result.seconds["sites"] = watch.seconds();
  return found;
}

FoundSites turned_round(FoundSites found) {
  for (Vec3f& normal : found.sites.normals) normal = -normal;
  found.begun.seconds.clear();
  return found;
}

}  // namespace isolux
