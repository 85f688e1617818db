#include "nrrd_header.h"
#include "nrrd_space.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace isolux::detail {
namespace {

// An axis without a direction: its own spacing, or what its first and last coordinate say.
double axis_step(const NrrdHeader& header, const NrrdAxis& axis) {
  if (axis.spacing) return *axis.spacing;
  if (axis.min && axis.max) {
    const auto intervals = double(axis.size - (axis.node_centered ? 1 : 0));
    if (intervals > 0.0) return (*axis.max - *axis.min) / intervals;
  }
  (void)header;
  return 1.0;
}

}  // namespace

NrrdFrame nrrd_frame(const NrrdHeader& header, std::span<const NrrdAxis> axes) {
  NrrdFrame frame;
  IndexToWorld& map = frame.lattice.frame;
  for (int a = 0; a < 3; ++a) {
    const NrrdAxis& axis = axes[std::size_t(a)];
    frame.lattice.size[a] = int(axis.size);
    if (header.has_directions) {
      if (!axis.direction)
        throw InvalidInput(fmt::format("{}: a spatial axis has the space direction 'none'", header.path));
      map.axes[a] = *axis.direction;
    } else {
      const double step = axis_step(header, axis);
      map.axes[a] = Vec3(0.0);
      map.axes[a][a] = step;
      // NRRD's minimum of a cell-centred axis is the face of its first cell.
      if (axis.min) map.origin[a] = *axis.min + (axis.node_centered ? 0.0 : 0.5 * step);
    }
    const double length = glm::length(map.axes[a]);
    if (!std::isfinite(length) || length == 0.0)
      throw InvalidInput(
          fmt::format("{}: axis {} has the spacing {}; it must be finite and not zero", header.path, a, length));
  }
  if (header.origin) map.origin = *header.origin;
  frame.space = "3D-right-handed";
  if (!header.space.empty()) {
    const auto space = nrrd_space(header.space);
    if (!space)
      throw InvalidInput(fmt::format(
          "{}: 'space: {}': supported are left-posterior-superior, right-anterior-superior, left-anterior-superior, "
          "scanner-xyz, 3D-right-handed and 3D-left-handed",
          header.path, header.space));
    frame.space = space->name;
    map.origin *= space->signs;
    for (int a = 0; a < 3; ++a) map.axes[a] *= space->signs;
  }
  const Mat3 unit(glm::normalize(map.axes[0]), glm::normalize(map.axes[1]), glm::normalize(map.axes[2]));
  // The volume of the cell of unit edges: a millionth is far flatter than any scanner's frame.
  if (!(std::fabs(glm::determinant(unit)) > 1e-6))
    throw InvalidInput(fmt::format("{}: the space directions span no volume", header.path));
  return frame;
}

}  // namespace isolux::detail
