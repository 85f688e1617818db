#include "near_field.h"

#include <isolux/core/quantile.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace isolux {

NearField::NearField(const Volume& volume)
    : field_(volume),
      gradient_to_world_(volume.lattice().frame.gradient_to_world()),
      world_to_index_(glm::inverse(volume.lattice().frame.axes)) {
  const Vec3 spacing = volume.lattice().frame.spacing();
  spacing_ = std::cbrt(spacing.x * spacing.y * spacing.z);
}

NearField::Ahead NearField::ahead(const Vec3& index) const { return ahead_of(field_.smooth_gradient(index)); }

NearField::Ahead NearField::ahead_of(const Vec3& gradient_here) const {
  const Vec3 gradient = gradient_to_world_ * gradient_here;
  const double steepness = glm::length(gradient);
  if (!(steepness > 0.0)) return {};
  return {.step = world_to_index_ * (gradient * (-spacing_ / steepness)),
          .downhill = gradient * (-1.0 / steepness),
          .fall = steepness * spacing_};
}

float NearField::openness(const Vec3& index, const Ahead& ahead, double isovalue, double step) const {
  if (!(ahead.fall > 0.0)) return 0.0f;
  return openness_of(field_.value(index + step * ahead.step), ahead, isovalue, step);
}

float NearField::openness_of(double there, const Ahead& ahead, double isovalue, double step) {
  return float(std::clamp((isovalue - there) / (ahead.fall * step), -1.0, 1.0));
}

double NearField::outwards(const Sites& sites) const {
  double lower = 0.0;
  for (std::size_t s = 0; s < std::min<std::size_t>(sites.size(), 4096); ++s) {
    lower -= glm::dot(field_.world_gradient(Vec3(sites.positions[s]), GradientKind::kCentralDifferences),
                      Vec3(sites.normals[s]));
  }
  return lower < 0.0 ? -1.0 : 1.0;
}

float most_weight(std::span<const float> weights) {
  const float usual = quantile(weights, 0.9);
  return usual > 0.0f ? 2.0f * usual : std::numeric_limits<float>::max();
}

}  // namespace isolux
