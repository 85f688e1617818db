#pragma once

#include <isolux/core/field.h>
#include <isolux/core/volume.h>

namespace isolux::bench {

/// Whether the side of lower values in front of a point (index space) of the level set {f = isovalue} is a pocket that
/// nothing leads out of: a flood over the points of the grid refined eight times, from those around a place just before
/// the surface, that meets no face of the box. An independent judge of where light cannot get in; necks narrower than
/// an eighth of a cell count as closed.
[[nodiscard]] bool is_in_closed_pocket(const Volume& volume, const Vec3& index, float isovalue);

}  // namespace isolux::bench
