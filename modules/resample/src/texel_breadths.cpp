#include "texel_breadths.h"

#include <algorithm>
#include <glm/common.hpp>

namespace isolux {

TexelBreadths::TexelBreadths(const Volume& volume, const Lattice& texels) : volume_(volume), reach_(0.0) {
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  for (int a = 0; a < 3; ++a) reach_ += glm::abs(to_volume.axes[a]);
}

double TexelBreadths::at(const Vec3& centre) const {
  const Index3 low = glm::max(Index3(glm::floor(centre - reach_ + 1e-6)), Index3(0));
  const Index3 high = glm::min(Index3(glm::ceil(centre + reach_ - 1e-6)), volume_.lattice().size - 1);
  float smallest = volume_.values(low.x, low.y, low.z);
  float largest = smallest;
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y) {
      const auto [a, b] = std::minmax_element(&volume_.values(low.x, y, z), &volume_.values(high.x, y, z) + 1);
      smallest = std::min(smallest, *a);
      largest = std::max(largest, *b);
    }
  return 0.5 * (double(largest) - double(smallest));
}

}  // namespace isolux
