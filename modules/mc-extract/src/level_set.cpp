#include "level_set.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace isolux::mc {

namespace {

float vertex_margin(const Lattice& lattice) {
  const IndexToWorld& frame = lattice.frame;
  double farthest = 0.0;
  for (int c = 0; c < 8; ++c) {
    const Vec3 corner = frame.world(Vec3(lattice.size - 1) * Vec3(c & 1, c >> 1 & 1, c >> 2));
    for (int a = 0; a < 3; ++a) farthest = std::max(farthest, std::fabs(corner[a]));
  }
  const Vec3 spacing = frame.spacing();
  const double resolution = std::ldexp(farthest, -23) / std::min({spacing.x, spacing.y, spacing.z});
  return float(std::clamp(16.0 * resolution, std::ldexp(1.0, -10), 0.25));
}

}  // namespace

LevelSet::LevelSet(const Lattice& lattice, const ExtractSettings& settings)
    : isovalue(settings.isovalue),
      outer(settings.outer),
      margin(vertex_margin(lattice)),
      mirrored(glm::determinant(lattice.frame.axes) < 0.0) {}

float LevelSet::fraction(float a, float b) const {
  const float t = (isovalue - a) / (b - a);
  // In this order a NaN, which only voxels that are not finite or differences that overflow can cause, ends at the
  // margin.
  return std::min(std::max(margin, t), 1.0f - margin);
}

}  // namespace isolux::mc
