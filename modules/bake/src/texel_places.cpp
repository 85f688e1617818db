#include "texel_places.h"

namespace isolux {

TexelPlaces::TexelPlaces(const Lattice& volume, const Lattice& texels)
    : positions_(volume, texels), has_site_(texels.count(), false) {}

std::optional<TexelPlaces> TexelPlaces::of(const Lattice& volume, const Lattice& texels,
                                           std::span<const Vec3f> positions) {
  TexelPlaces places(volume, texels);
  std::size_t site = 0;
  for (std::size_t texel = 0; texel < places.has_site_.size() && site < positions.size(); ++texel) {
    if (places.positions_.of(texel) != positions[site]) continue;
    places.has_site_[texel] = true;
    ++site;
  }
  if (site < positions.size()) return {};
  return places;
}

std::vector<Vec3f> TexelPlaces::next(std::size_t& first, std::size_t count) const {
  std::vector<Vec3f> positions;
  for (; first < has_site_.size() && positions.size() < count; ++first)
    if (has_site_[first]) positions.push_back(positions_.of(first));
  return positions;
}

}  // namespace isolux
