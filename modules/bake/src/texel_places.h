#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/sample_set.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace isolux {

/// Sites at texels, and texels at sites.
struct Places {
  Sites sites;
  std::vector<std::size_t> texel;   ///< of a site
  std::vector<std::uint32_t> site;  ///< of a texel that has one
  std::vector<std::uint8_t> has_site;
};

inline Places place(Sites sites, const Lattice& volume, const Lattice& texels) {
  Places places;
  places.sites = std::move(sites);
  places.texel.resize(places.sites.size());
  places.site.resize(texels.count());
  places.has_site.assign(texels.count(), 0);
  const IndexToWorld to_texels = index_to_index(volume, texels);
  for (std::size_t s = 0; s < places.texel.size(); ++s) {
    const Vec3 at = to_texels.world(Vec3(places.sites.positions[s]));
    const std::size_t texel = texels.offset(int(std::lround(at.x)), int(std::lround(at.y)), int(std::lround(at.z)));
    places.texel[s] = texel;
    places.site[texel] = std::uint32_t(s);
    places.has_site[texel] = 1;
  }
  return places;
}

inline Sites sites_at(const Places& places, const std::vector<std::size_t>& texels) {
  Sites result;
  for (const std::size_t texel : texels) {
    const std::uint32_t s = places.site[texel];
    result.positions.push_back(places.sites.positions[s]);
    result.isovalues.push_back(places.sites.isovalues[s]);
    result.normals.push_back(places.sites.normals[s]);
  }
  return result;
}

}  // namespace isolux
