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

}  // namespace

SphericalTriangle::SphericalTriangle(const Vec3& a, const Vec3& b, const Vec3& c) : a_(a), b_(b) {
  // Van Oosterom & Strackee 1983.
  const double triple = std::fabs(glm::dot(a, glm::cross(b, c)));
  area_ = 2.0 * std::atan2(triple, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
  const Vec3 ab = glm::cross(a, b);
  const Vec3 ac = glm::cross(a, c);
  angle_ = std::atan2(glm::length(glm::cross(ab, ac)), glm::dot(ab, ac));
  aside_ = glm::normalize(c - glm::dot(c, a) * a);
  cosine_ab_ = glm::dot(a, b);
}

Vec3 SphericalTriangle::direction(double u, double v) const {
  const double part = u * area_;
  const double s = std::sin(part - angle_);
  const double t = std::cos(part - angle_);
  const double sin_angle = std::sin(angle_);
  const double cos_angle = std::cos(angle_);
  const double p = t - cos_angle;
  const double r = s + sin_angle * cosine_ab_;
  const double below = (r * s + p * t) * sin_angle;
  const double q = below != 0.0 ? std::clamp(((r * t - p * s) * cos_angle - r) / below, -1.0, 1.0) : 1.0;
  const Vec3 corner = q * a_ + std::sqrt(1.0 - q * q) * aside_;
  const double z = 1.0 - v * (1.0 - glm::dot(corner, b_));
  const Vec3 aside = corner - glm::dot(corner, b_) * b_;
  const double length = glm::length(aside);
  if (!(length > 0.0)) return b_;
  return z * b_ + std::sqrt(std::max(0.0, 1.0 - z * z)) * (aside / length);
}

SunDisc sun_disc(const SunLight& sun) {
  const double radius = double(sun.angular_diameter_deg) * std::numbers::pi / 360.0;
  const double half = std::sin(0.5 * radius);
  const double one_minus_cosine = 2.0 * half * half;
  // Irradiance at normal incidence = radiance * pi sin^2(radius); weight = radiance * 2 pi (1 - cos(radius)).
  return {.one_minus_cosine = one_minus_cosine, .weight = 2.0 / (2.0 - one_minus_cosine) * Vec3(sun.irradiance)};
}

PreparedLight::PreparedLight(const Light& light) : shape_(LightView::Cone{}) {
  if (const auto* sun = std::get_if<SunLight>(&light)) {
    const SunDisc disc = sun_disc(*sun);
    shape_ = LightView::Cone{.frame = frame_about(glm::normalize(Vec3(sun->direction))),
                             .one_minus_cosine = disc.one_minus_cosine,
                             .weight = disc.weight,
                             .distance = std::numeric_limits<double>::infinity(),
                             .radius = 0.0};
  } else if (const auto* rectangle = std::get_if<RectangleLight>(&light)) {
    const Vec3 cross = glm::cross(Vec3(rectangle->u), Vec3(rectangle->v));
    const double length = glm::length(cross);
    shape_ = Parallelogram{.center = rectangle->center,
                           .u = Vec3(rectangle->u),
                           .v = Vec3(rectangle->v),
                           .normal = cross / length,
                           .area = 4.0 * length,
                           .radiance = Vec3(rectangle->radiance)};
  } else if (const auto* sphere = std::get_if<SphereLight>(&light)) {
    shape_ = Ball{.center = sphere->center, .radius = double(sphere->radius), .radiance = Vec3(sphere->radiance)};
  }
}

LightView PreparedLight::from(const Vec3& point) const {
  return std::visit([&](const auto& shape) { return view(shape, point); }, shape_);
}

LightView PreparedLight::view(const LightView::Cone& sun, const Vec3& /*point*/) {
  LightView seen;
  seen.shape_ = sun;
  return seen;
}

LightView PreparedLight::view(const Parallelogram& light, const Vec3& point) {
  LightView seen;
  const Vec3 center = light.center - point;
  const double height = -glm::dot(center, light.normal);
  if (!(height > 0.0)) return seen;
  const Vec3 corners[4] = {glm::normalize(center - light.u - light.v), glm::normalize(center + light.u - light.v),
                           glm::normalize(center + light.u + light.v), glm::normalize(center - light.u + light.v)};
  seen.shape_ = LightView::Quad{.center = center,
                                .u = light.u,
                                .v = light.v,
                                .normal = light.normal,
                                .height = height,
                                .area = light.area,
                                .radiance = light.radiance,
                                .halves = {SphericalTriangle(corners[0], corners[1], corners[2]),
                                           SphericalTriangle(corners[0], corners[2], corners[3])}};
  return seen;
}

LightView PreparedLight::view(const Ball& light, const Vec3& point) {
  LightView seen;
  const Vec3 way = light.center - point;
  const double distance = glm::length(way);
  const double sine = light.radius / distance;
  if (!(sine < 1.0)) return seen;
  const double one_minus_cosine = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
  seen.shape_ = LightView::Cone{.frame = frame_about(way / distance),
                                .one_minus_cosine = one_minus_cosine,
                                .weight = 2.0 * std::numbers::pi * one_minus_cosine * light.radiance,
                                .distance = distance,
                                .radius = light.radius};
  return seen;
}

std::optional<LightSample> LightView::sample(double u, double v) const {
  if (const auto* cone = std::get_if<Cone>(&shape_)) return drawn(*cone, u, v);
  if (const auto* quad = std::get_if<Quad>(&shape_)) return drawn(*quad, u, v);
  return std::nullopt;
}

LightSample LightView::drawn(const Cone& cone, double u, double v) {
  const Vec3 local = cone_direction(u, v, cone.one_minus_cosine);
  LightSample sample{.towards = cone.frame.world(local), .distance = cone.distance, .weight = cone.weight};
  if (cone.distance == std::numeric_limits<double>::infinity()) return sample;
  const double aside = cone.distance * cone.distance * std::max(0.0, 1.0 - local.z * local.z);
  const double inside = std::sqrt(std::max(0.0, cone.radius * cone.radius - aside));
  sample.distance = cone.distance * local.z - inside;
  return sample;
}

LightSample LightView::drawn(const Quad& quad, double u, double v) {
  const auto& [first, second] = quad.halves;
  const double solid_angle = first.area() + second.area();
  LightSample sample;
  if (solid_angle >= kSmallSolidAngle) {
    const double chosen = u * solid_angle;
    sample.towards = chosen < first.area()
                         ? first.direction(chosen / first.area(), v)
                         : second.direction(std::min((chosen - first.area()) / second.area(), 1.0), v);
    sample.distance = quad.height / std::max(-glm::dot(sample.towards, quad.normal), 1e-300);
    sample.weight = solid_angle * quad.radiance;
    return sample;
  }
  const Vec3 way = quad.center + (2.0 * u - 1.0) * quad.u + (2.0 * v - 1.0) * quad.v;
  sample.distance = glm::length(way);
  sample.towards = way / sample.distance;
  sample.weight = quad.radiance * (quad.area * quad.height / (sample.distance * sample.distance * sample.distance));
  return sample;
}

}  // namespace isolux
