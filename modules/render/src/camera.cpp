#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/render/camera.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

namespace isolux {
namespace {

/// A camera turned as the view says, its eye in the world's origin.
Camera turned_camera(const View& view) {
  // By way of 1: squares of long and of short ones are no numbers.
  const double largest = std::max({std::fabs(view.up.x), std::fabs(view.up.y), std::fabs(view.up.z)});
  const Vec3 scaled = view.up / largest;
  if (!(largest > 0.0) || !std::isfinite(scaled.x + scaled.y + scaled.z))
    throw InvalidInput(fmt::format("up = ({}, {}, {}): allowed is a direction", view.up.x, view.up.y, view.up.z));
  const Vec3 up = glm::normalize(scaled);
  constexpr double kAlong = 1e-6;  // sine of the angle below which x is taken for up itself
  const Vec3 x(1.0, 0.0, 0.0);
  const Vec3 y(0.0, 1.0, 0.0);
  const Vec3 side = glm::length(glm::cross(up, x)) > kAlong ? x : y;
  const Vec3 across = glm::normalize(side - glm::dot(side, up) * up);
  const Vec3 ahead = glm::cross(up, across);
  const double azimuth = glm::radians(view.azimuth_deg);
  const double elevation = glm::radians(view.elevation_deg);
  Camera camera;
  camera.projection = view.projection;
  camera.right = std::cos(azimuth) * across + std::sin(azimuth) * ahead;
  const Vec3 level = -std::sin(azimuth) * across + std::cos(azimuth) * ahead;
  camera.forward = std::cos(elevation) * level - std::sin(elevation) * up;
  camera.up = glm::cross(camera.right, camera.forward);
  return camera;
}

constexpr double kInfinitelyFar = std::numeric_limits<double>::infinity();
constexpr double kInner = 0.98;  // of the picture's width and height: what framed points may fill

}  // namespace

Vec3 Camera::direction(double x, double y) const {
  if (projection == Projection::kOrthographic) return forward;
  return glm::normalize(forward + half_height * (x * right + y * up));
}

Vec3 Camera::origin(double x, double y) const {
  if (projection == Projection::kPerspective) return eye;
  return eye + half_height * (x * right + y * up);
}

Camera orbit_camera(const Lattice& volume, const View& view, double aspect) {
  const Vec3 last(volume.size - 1);
  const Vec3 middle = volume.frame.world(0.5 * last);
  Camera camera = turned_camera(view);
  const bool is_parallel = view.projection == Projection::kOrthographic;
  // The nearest eye that has every corner of the box within the picture.
  double distance = 0.0;
  double half = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index((corner & 1) * last.x, (corner >> 1 & 1) * last.y, (corner >> 2) * last.z);
    const Vec3 p = volume.frame.world(index) - middle;
    const double across = std::max(std::fabs(glm::dot(p, camera.right)) / aspect, std::fabs(glm::dot(p, camera.up)));
    half = std::max(half, across);
    distance = std::max(distance, (is_parallel ? 0.0 : across / camera.half_height) - glm::dot(p, camera.forward));
  }
  if (is_parallel) camera.half_height = half;
  camera.eye = middle - camera.forward * distance;
  return camera;
}

Camera orbit_camera(const Lattice& volume, double azimuth_deg, double elevation_deg, double aspect) {
  return orbit_camera(volume, View{.azimuth_deg = azimuth_deg, .elevation_deg = elevation_deg}, aspect);
}

// A point at depth f is in view of an eye at depth -d, c to the side, if |place - c| <= half (f + d): both ends of all
// these intervals are met by the smallest d with c in the middle.
void Framing::Reach::add(double place, double depth, double half) {
  low = std::min(low, place + half * depth);
  high = std::max(high, place - half * depth);
}

Framing::Framing(const View& view, double aspect)
    : turned_(turned_camera(view)),
      aspect_(aspect),
      half_(view.projection == Projection::kOrthographic ? 0.0 : kInner * turned_.half_height),
      across_{.low = kInfinitelyFar, .high = -kInfinitelyFar},
      upwards_(across_),
      nearest_(kInfinitelyFar) {}

void Framing::add(std::span<const Vec3f> points) {
  if (empty_ && !points.empty()) origin_ = Vec3(points.front());
  empty_ = empty_ && points.empty();
  for (const Vec3f& point : points) {
    const Vec3 p = Vec3(point) - origin_;
    const double depth = glm::dot(p, turned_.forward);
    across_.add(glm::dot(p, turned_.right), depth, half_ * aspect_);
    upwards_.add(glm::dot(p, turned_.up), depth, half_);
    nearest_ = std::min(nearest_, depth);
  }
}

Camera Framing::camera() const {
  if (empty_) throw InvalidInput("a camera that frames points: there are none");
  Camera camera = turned_;
  const bool is_parallel = camera.projection == Projection::kOrthographic;
  const double wanted = std::max(across_.half_width() / aspect_, upwards_.half_width());
  const double distance = is_parallel ? wanted - nearest_ : wanted / half_;
  if (is_parallel) camera.half_height = wanted / kInner;
  camera.eye = origin_ + across_.middle() * camera.right + upwards_.middle() * camera.up - distance * camera.forward;
  return camera;
}

Camera framing_camera(std::span<const Vec3f> points, const View& view, double aspect) {
  Framing framing(view, aspect);
  framing.add(points);
  return framing.camera();
}

}  // namespace isolux
