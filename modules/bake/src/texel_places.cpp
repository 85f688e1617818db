#include "texel_places.h"

#include <algorithm>

#include "grid_index.h"

namespace isolux {

TexelPlaces::TexelPlaces(const Lattice& volume, const Lattice& texels)
    : size_(texels.size),
      to_volume_(index_to_index(texels, volume)),
      last_(volume.size - 1),
      has_site_(texels.count(), false) {}

Vec3f TexelPlaces::position(std::size_t texel) const {
  Vec3f position(to_volume_.world(Vec3(index_of(size_, texel))));
  for (int a = 0; a < 3; ++a) position[a] = std::clamp(position[a], 0.0f, last_[a]);
  return position;
}

std::optional<TexelPlaces> TexelPlaces::of(const Lattice& volume, const Lattice& texels,
                                           std::span<const Vec3f> positions) {
  TexelPlaces places(volume, texels);
  std::size_t site = 0;
  for (std::size_t texel = 0; texel < places.has_site_.size() && site < positions.size(); ++texel) {
    if (places.position(texel) != positions[site]) continue;
    places.has_site_[texel] = true;
    ++site;
  }
  if (site < positions.size()) return {};
  return places;
}

std::vector<Vec3f> TexelPlaces::next(std::size_t& first, std::size_t count) const {
  std::vector<Vec3f> positions;
  for (; first < has_site_.size() && positions.size() < count; ++first)
    if (has_site_[first]) positions.push_back(position(first));
  return positions;
}

}  // namespace isolux
