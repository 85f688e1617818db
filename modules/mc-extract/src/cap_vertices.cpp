#include <isolux/mc_extract/cap_vertices.h>
#include <isolux/mc_extract/vertex_resolution.h>

#include <cmath>
#include <glm/matrix.hpp>

namespace isolux {

std::vector<std::uint32_t> cap_vertices(const IsoMesh& mesh, const Lattice& volume) {
  const Mat3 to_index = glm::inverse(volume.frame.axes);
  // A surface's vertices keep a margin from grid points.
  const Vec3 tolerance = 0.5 * Vec3(vertex_margin(volume));
  const auto is_of_cap = [&](const Vec3& index) {
    bool on_box = false;
    for (int a = 0; a < 3; ++a) {
      const double nearest = std::round(index[a]);
      if (std::fabs(index[a] - nearest) > tolerance[a]) return false;
      on_box = on_box || nearest == 0.0 || nearest == double(volume.size[a] - 1);
    }
    return on_box;
  };
  std::vector<std::uint32_t> vertices;
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    if (is_of_cap(to_index * (Vec3(p[0], p[1], p[2]) - volume.frame.origin)))
      vertices.push_back(std::uint32_t(v.idx()));
  }
  return vertices;
}

}  // namespace isolux
