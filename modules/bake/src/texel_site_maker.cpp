#include "texel_site_maker.h"

#include <utility>

#include "texel_positions.h"

namespace isolux {

Sites TexelSiteMaker::make(std::span<const std::size_t> texels, std::vector<std::uint8_t>* lit) const {
  const TexelPositions places(volume_.lattice(), request_.texels);
  std::vector<Vec3f> positions(texels.size());
  for (std::size_t i = 0; i < texels.size(); ++i) positions[i] = places.of(texels[i]);
  std::vector<Vec3f> wanted;
  for (std::size_t i = 0; i < texels.size(); ++i)
    if (request_.only == nullptr || (*request_.only)[texels[i]]) wanted.push_back(positions[i]);
  Sites sites = make_sites(volume_, std::move(wanted), request_, run_);
  if (lit == nullptr) return sites;
  // Those without a site were left out, the order kept; no two texels share a place.
  lit->assign(texels.size(), 0);
  std::size_t next = 0;
  for (std::size_t i = 0; i < texels.size() && next < sites.size(); ++i) {
    if (sites.positions[next] != positions[i]) continue;
    (*lit)[i] = 1;
    ++next;
  }
  return sites;
}

}  // namespace isolux
