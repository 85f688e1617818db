#include "level_set.h"

#include <isolux/mc_extract/vertex_resolution.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

namespace isolux::mc {

Vec3f vertex_margin(const Lattice& lattice) {
  const Vec3 resolution = vertex_resolution(lattice);
  Vec3f margin;
  // In this order a resolution that is no number, of a frame beyond any use, gives the largest margin.
  for (int a = 0; a < 3; ++a) margin[a] = float(std::max(std::min(0.25, 16.0 * resolution[a]), std::ldexp(1.0, -10)));
  return margin;
}

LevelSet::LevelSet(const Lattice& lattice, const ExtractSettings& settings)
    : isovalue(settings.isovalue),
      outer(settings.outer),
      margin(vertex_margin(lattice)),
      mirrored(glm::determinant(lattice.frame.axes) < 0.0) {}

float LevelSet::fraction(float a, float b, int direction) const {
  float least = 0.0f;
  for (int axis = 0; axis < 3; ++axis)
    if ((direction >> axis & 1) != 0) least = std::max(least, margin[axis]);
  const float t = (isovalue - a) / (b - a);
  // In this order a NaN, which only voxels that are not finite or differences that overflow can cause, ends at the
  // margin.
  return std::min(std::max(least, t), 1.0f - least);
}

}  // namespace isolux::mc
