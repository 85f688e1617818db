#include "light_sources.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace isolux {
namespace {

// Below this solid angle the directions to a rectangle are so alike that drawing by area is as good, and the angles of
// the spherical triangles begin to drown in rounding.
constexpr double kSmallSolidAngle = 1e-3;

/// A triangle on the unit sphere, corners as unit vectors.
struct SphericalTriangle {
  Vec3 a;
  Vec3 b;
  Vec3 c;

  /// Van Oosterom & Strackee 1983.
  [[nodiscard]] double area() const {
    const double triple = std::fabs(glm::dot(a, glm::cross(b, c)));
    return 2.0 * std::atan2(triple, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
  }

  /// A direction uniform in the triangle (Arvo, "Stratified sampling of spherical triangles", 1995).
  [[nodiscard]] Vec3 direction(double triangle_area, double u, double v) const {
    const Vec3 ab = glm::cross(a, b);
    const Vec3 ac = glm::cross(a, c);
    const double angle = std::atan2(glm::length(glm::cross(ab, ac)), glm::dot(ab, ac));
    const double part = u * triangle_area;
    const double s = std::sin(part - angle);
    const double t = std::cos(part - angle);
    const double sin_angle = std::sin(angle);
    const double cos_angle = std::cos(angle);
    const double p = t - cos_angle;
    const double r = s + sin_angle * glm::dot(a, b);
    const double below = (r * s + p * t) * sin_angle;
    const double q = below != 0.0 ? std::clamp(((r * t - p * s) * cos_angle - r) / below, -1.0, 1.0) : 1.0;
    const Vec3 corner = q * a + std::sqrt(1.0 - q * q) * glm::normalize(c - glm::dot(c, a) * a);
    const double z = 1.0 - v * (1.0 - glm::dot(corner, b));
    const Vec3 aside = corner - glm::dot(corner, b) * b;
    const double length = glm::length(aside);
    if (!(length > 0.0)) return b;
    return z * b + std::sqrt(std::max(0.0, 1.0 - z * z)) * (aside / length);
  }
};

}  // namespace

SunDisc sun_disc(const SunLight& sun) {
  const double radius = double(sun.angular_diameter_deg) * std::numbers::pi / 360.0;
  const double half = std::sin(0.5 * radius);
  const double one_minus_cosine = 2.0 * half * half;
  // Irradiance at normal incidence = radiance * pi sin^2(radius); weight = radiance * 2 pi (1 - cos(radius)).
  return {.one_minus_cosine = one_minus_cosine, .weight = 2.0 / (2.0 - one_minus_cosine) * Vec3(sun.irradiance)};
}

PreparedLight::PreparedLight(const Light& light) : shape_(Cone{}) {
  if (const auto* sun = std::get_if<SunLight>(&light)) {
    shape_ = Cone{.frame = frame_about(glm::normalize(Vec3(sun->direction))), .disc = sun_disc(*sun)};
  } else if (const auto* rectangle = std::get_if<RectangleLight>(&light)) {
    const Vec3 cross = glm::cross(Vec3(rectangle->u), Vec3(rectangle->v));
    const double length = glm::length(cross);
    shape_ = Parallelogram{.center = Vec3(rectangle->center),
                           .u = Vec3(rectangle->u),
                           .v = Vec3(rectangle->v),
                           .normal = cross / length,
                           .area = 4.0 * length,
                           .radiance = Vec3(rectangle->radiance)};
  } else if (const auto* sphere = std::get_if<SphereLight>(&light)) {
    shape_ = Ball{.center = Vec3(sphere->center), .radius = double(sphere->radius), .radiance = Vec3(sphere->radiance)};
  }
}

std::optional<LightSample> PreparedLight::sample(const Vec3& from, double u, double v) const {
  return std::visit([&](const auto& shape) { return sample_shape(shape, from, u, v); }, shape_);
}

std::optional<LightSample> PreparedLight::sample_shape(const Cone& sun, const Vec3& /*from*/, double u, double v) {
  return LightSample{.towards = sun.frame.world(cone_direction(u, v, sun.disc.one_minus_cosine)),
                     .distance = std::numeric_limits<double>::infinity(),
                     .weight = sun.disc.weight};
}

std::optional<LightSample> PreparedLight::sample_shape(const Parallelogram& light, const Vec3& from, double u,
                                                       double v) {
  const Vec3 center = light.center - from;
  const double height = -glm::dot(center, light.normal);
  if (!(height > 0.0)) return std::nullopt;
  const Vec3 corners[4] = {glm::normalize(center - light.u - light.v), glm::normalize(center + light.u - light.v),
                           glm::normalize(center + light.u + light.v), glm::normalize(center - light.u + light.v)};
  const SphericalTriangle first{corners[0], corners[1], corners[2]};
  const SphericalTriangle second{corners[0], corners[2], corners[3]};
  const double first_area = first.area();
  const double second_area = second.area();
  const double solid_angle = first_area + second_area;
  LightSample sample;
  if (solid_angle >= kSmallSolidAngle) {
    const double chosen = u * solid_angle;
    sample.towards = chosen < first_area
                         ? first.direction(first_area, chosen / first_area, v)
                         : second.direction(second_area, std::min((chosen - first_area) / second_area, 1.0), v);
    sample.distance = height / std::max(-glm::dot(sample.towards, light.normal), 1e-300);
    sample.weight = solid_angle * light.radiance;
    return sample;
  }
  const Vec3 way = center + (2.0 * u - 1.0) * light.u + (2.0 * v - 1.0) * light.v;
  sample.distance = glm::length(way);
  sample.towards = way / sample.distance;
  sample.weight = light.radiance * (light.area * height / (sample.distance * sample.distance * sample.distance));
  return sample;
}

std::optional<LightSample> PreparedLight::sample_shape(const Ball& light, const Vec3& from, double u, double v) {
  const Vec3 way = light.center - from;
  const double distance = glm::length(way);
  const double sine = light.radius / distance;
  if (!(sine < 1.0)) return std::nullopt;
  const double one_minus_cosine = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
  const Vec3 local = cone_direction(u, v, one_minus_cosine);
  const double aside = distance * distance * std::max(0.0, 1.0 - local.z * local.z);
  const double inside = std::sqrt(std::max(0.0, light.radius * light.radius - aside));
  return LightSample{.towards = frame_about(way / distance).world(local),
                     .distance = distance * local.z - inside,
                     .weight = 2.0 * std::numbers::pi * one_minus_cosine * light.radiance};
}

}  // namespace isolux
