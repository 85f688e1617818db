#include "make_volume.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace isolux::detail {

void require_frame(const std::string& path, const IndexToWorld& frame) {
  const auto finite = [](const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  if (!finite(frame.origin)) throw InvalidInput(fmt::format("{}: the origin is not finite", path));
  Mat3 unit(1.0);
  for (int a = 0; a < 3; ++a) {
    const double length = glm::length(frame.axes[a]);
    if (!std::isfinite(length) || !(length > 0.0))
      throw InvalidInput(
          fmt::format("{}: axis {} has the spacing {}; it must be finite and not zero", path, a, length));
    unit[a] = frame.axes[a] / length;
  }
  // The volume of the cell of unit edges: a millionth is far flatter than any scanner's.
  if (!(std::fabs(glm::determinant(unit)) > 1e-6))
    throw InvalidInput(fmt::format("{}: the directions of the axes span no volume", path));
}

StoredVolume make_volume(const std::string& name, Lattice lattice, DecodedValues values, ScalarType stored,
                         std::string space, const ReadOptions& options) {
  if (options.spacing) {
    for (int a = 0; a < 3; ++a) {
      const double step = (*options.spacing)[a];
      if (!std::isfinite(step) || step <= 0.0)
        throw InvalidInput(fmt::format("{}: spacing {} on axis {}: allowed is a finite number above 0", name, step, a));
      lattice.frame.axes[a] = glm::normalize(lattice.frame.axes[a]) * step;
    }
  }
  require_frame(name, lattice.frame);
  StoredVolume volume{.values = {},
                      .name = name,
                      .stored_type = options.subtract != 0.0 ? ScalarType::kFloat32 : stored,
                      .space = std::move(space),
                      .rounded = values.rounded};
  std::visit([&](auto& list) { volume.values = Grid(lattice, std::move(list)); }, values.list);
  if (options.nodata && !values.found_nodata)
    volume.remarks.push_back(fmt::format("{}: no voxel has the value {} that stands for none", name, *options.nodata));
  return volume;
}

}  // namespace isolux::detail
