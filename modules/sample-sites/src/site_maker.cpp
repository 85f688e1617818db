#include "site_maker.h"

#include <algorithm>
#include <cmath>

namespace isolux {

SiteMaker::SiteMaker(const Volume& volume, const SiteRequest& request)
    : field_(volume), request_(request), last_(volume.lattice().size - 1) {}

std::optional<Site> SiteMaker::at(Vec3f position) const {
  if (!(std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z))) return {};
  for (int a = 0; a < 3; ++a) position[a] = std::clamp(position[a], 0.0f, last_[a]);
  const Vec3 index(position);
  const auto isovalue = float(field_.value(index));
  if (request_.isovalues && !(isovalue >= request_.isovalues->low && isovalue <= request_.isovalues->high)) return {};
  const Vec3 normal = field_.normal(index, request_.outer, request_.gradient);
  if (normal == Vec3(0.0) || field_.is_flat_around(index)) return {};
  return Site{.position = position, .isovalue = isovalue, .normal = Vec3f(normal)};
}

void SiteMaker::append(const Vec3f& position, Sites& sites) const {
  const std::optional<Site> site = at(position);
  if (!site) return;
  sites.positions.push_back(site->position);
  sites.isovalues.push_back(site->isovalue);
  sites.normals.push_back(site->normal);
}

}  // namespace isolux
