#include "near_field.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace isolux {

NearField::NearField(const Volume& volume)
    : field_(volume), world_to_index_(glm::inverse(volume.lattice().frame.axes)) {
  const Vec3 spacing = volume.lattice().frame.spacing();
  spacing_ = std::cbrt(spacing.x * spacing.y * spacing.z);
}

float NearField::openness(const Vec3& index, double isovalue, double step) const {
  return openness(index, gradient(index), isovalue, step);
}

Vec3 NearField::gradient(const Vec3& index) const {
  return field_.world_gradient(index, GradientKind::kCentralDifferences);
}

float NearField::openness(const Vec3& index, const Vec3& gradient, double isovalue, double step) const {
  const double steepness = glm::length(gradient);
  if (!(steepness > 0.0)) return 0.0f;
  const double length = step * spacing_;
  const double ahead = field_.value(index - world_to_index_ * (gradient * (length / steepness)));
  return float(std::clamp((isovalue - ahead) / (steepness * length), -1.0, 1.0));
}

double NearField::outwards(const Sites& sites) const {
  double lower = 0.0;
  for (std::size_t s = 0; s < std::min<std::size_t>(sites.size(), 4096); ++s) {
    lower -= glm::dot(field_.world_gradient(Vec3(sites.positions[s]), GradientKind::kCentralDifferences),
                      Vec3(sites.normals[s]));
  }
  return lower < 0.0 ? -1.0 : 1.0;
}

}  // namespace isolux
