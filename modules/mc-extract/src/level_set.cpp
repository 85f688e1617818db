#include "level_set.h"

#include <algorithm>
#include <glm/matrix.hpp>

namespace isolux::mc {

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
