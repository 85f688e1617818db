#include "nrrd_header.h"
#include "nrrd_space.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include "make_volume.h"

namespace isolux::detail {
namespace {

// An axis without a direction: its own spacing, or what its first and last coordinate say.
double axis_step(const NrrdAxis& axis) {
  if (axis.spacing) return *axis.spacing;
  if (axis.min && axis.max) {
    const auto intervals = double(axis.size - (axis.node_centered ? 1 : 0));
    if (intervals > 0.0) return (*axis.max - *axis.min) / intervals;
  }
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
      const double step = axis_step(axis);
      map.axes[a] = Vec3(0.0);
      map.axes[a][a] = step;
      // NRRD's minimum of a cell-centred axis is the face of its first cell.
      if (axis.min) map.origin[a] = *axis.min + (axis.node_centered ? 0.0 : 0.5 * step);
    }
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
  require_frame(header.path, map);
  return frame;
}

}  // namespace isolux::detail
