#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/lattice.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace isolux {

Vec3 IndexToWorld::index(const Vec3& world) const { return glm::inverse(axes) * (world - origin); }

Mat3 IndexToWorld::gradient_to_world() const { return glm::transpose(glm::inverse(axes)); }

Vec3 IndexToWorld::spacing() const { return {glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])}; }

Lattice cell_lattice(const Lattice& volume, Index3 texels) {
  Lattice result;
  result.size = texels;
  Vec3 first(0.0);
  for (int a = 0; a < 3; ++a) {
    if (volume.size[a] < 2 || texels[a] < 1) {
      throw InvalidInput(
          fmt::format("a texture of {}x{}x{} texels over a volume of {}x{}x{} grid points: it needs at least 1 texel "
                      "and 2 grid points on each axis",
                      texels.x, texels.y, texels.z, volume.size.x, volume.size.y, volume.size.z));
    }
    const double step = double(volume.size[a] - 1) / texels[a];
    first[a] = 0.5 * step;
    result.frame.axes[a] = volume.frame.axes[a] * step;
  }
  result.frame.origin = volume.frame.world(first);
  return result;
}

Lattice cell_lattice(const Lattice& volume) { return cell_lattice(volume, volume.size - 1); }

Lattice voxel_lattice(const Lattice& volume) { return volume; }

IndexToWorld index_to_index(const Lattice& from, const Lattice& to) {
  const Mat3 inverse = glm::inverse(to.frame.axes);
  return {.origin = inverse * (from.frame.origin - to.frame.origin), .axes = inverse * from.frame.axes};
}

}  // namespace isolux
