#include <isolux/mc_extract/vertex_resolution.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace isolux {

Vec3 vertex_resolution(const Lattice& lattice) {
  Vec3 farthest(0.0);
  for (int c = 0; c < 8; ++c) {
    const Vec3 corner = lattice.frame.world(Vec3(lattice.size - 1) * Vec3(c & 1, c >> 1 & 1, c >> 2));
    farthest = glm::max(farthest, glm::abs(corner));
  }
  // Rows of the map to index space: an index coordinate errs by their product with the world coordinates' errors,
  // which are independent of each other.
  const Mat3 to_index = lattice.frame.gradient_to_world();
  Vec3 resolution;
  for (int a = 0; a < 3; ++a) resolution[a] = std::ldexp(glm::length(to_index[a] * farthest), -23);
  return resolution;
}

Vec3f vertex_margin(const Lattice& lattice) {
  const Vec3 resolution = vertex_resolution(lattice);
  Vec3f margin;
  // In this order a resolution that is no number, of a frame beyond any use, gives the largest margin.
  for (int a = 0; a < 3; ++a) margin[a] = float(std::max(std::min(0.25, 16.0 * resolution[a]), std::ldexp(1.0, -10)));
  return margin;
}

double places_a_voxel(const Lattice& lattice) {
  const Vec3 resolution = vertex_resolution(lattice);
  return 1.0 / std::max({resolution.x, resolution.y, resolution.z});
}

}  // namespace isolux
