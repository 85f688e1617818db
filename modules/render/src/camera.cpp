#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/render/camera.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <vector>

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

/// Points by their place in one direction of the picture (x) and their depth (y), corners of the convex hull alone:
/// from wherever an eye looks these are the ends of what it sees.
using Outline = std::vector<glm::dvec2>;

/// Across one direction of the picture: between which places the middle of all views that hold the points may be. The
/// less the eye is moved back, the further they are apart.
struct Reach {
  double low = kInfinitelyFar;
  double high = -kInfinitelyFar;
  // A point at depth f is in view of an eye at depth -d, c to the side, if |place - c| <= half (f + d): both ends of
  // all these intervals are met by the smallest d with c in the middle.
  Reach(const Outline& outline, double half) {
    for (const glm::dvec2& p : outline) {
      low = std::min(low, p.x + half * p.y);
      high = std::max(high, p.x - half * p.y);
    }
  }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
  [[nodiscard]] double half_width() const { return 0.5 * (high - low); }
};

/// Where to the side an eye at depth -distance sees as much of the points on one side as on the other: near ones look
/// farther out. `middle` is where to begin. Newton's method, halving where it would leave what is left.
double centred(double middle, const Outline& outline, double distance) {
  constexpr int kMostPasses = 60;
  double low = -kInfinitelyFar;
  double high = kInfinitelyFar;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    glm::dvec2 first(0.0);
    glm::dvec2 last(0.0);
    double least = kInfinitelyFar;
    double most = -kInfinitelyFar;
    for (const glm::dvec2& p : outline) {
      const glm::dvec2 seen(p.x, p.y + distance);
      const double tangent = (seen.x - middle) / seen.y;
      if (tangent < least) {
        least = tangent;
        first = seen;
      }
      if (tangent > most) {
        most = tangent;
        last = seen;
      }
    }
    // The two ends would be at the same distance there; if others are the ends then, there is another pass.
    double next = (first.x * last.y + last.x * first.y) / (first.y + last.y);
    (least + most > 0.0 ? low : high) = middle;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (!(std::fabs(least + most) > 1e-12 * (most - least)) || !std::isfinite(next)) break;
    middle = next;
  }
  return middle;
}

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

Framing::Framing(const View& view, double aspect) : turned_(turned_camera(view)), aspect_(aspect) {}

void Framing::add(std::span<const Vec3f> points) {
  if (empty() && !points.empty()) origin_ = Vec3(points.front());
  // A mesh's vertices come slice by slice, each beyond those before: a few of them all first, and the hulls are nearly
  // what they will be.
  for (const std::size_t step : {std::size_t(101), std::size_t(1)})
    for (std::size_t i = 0; i < points.size(); i += step) {
      const Vec3 p = Vec3(points[i]) - origin_;
      const double depth = glm::dot(p, turned_.forward);
      across_.add({glm::dot(p, turned_.right), depth});
      upwards_.add({glm::dot(p, turned_.up), depth});
    }
}

Camera Framing::camera() const {
  if (empty()) throw InvalidInput("a camera that frames points: there are none");
  Camera camera = turned_;
  const bool is_parallel = camera.projection == Projection::kOrthographic;
  const double half = is_parallel ? 0.0 : kInner * camera.half_height;  // of the view's height at depth 1
  const Outline beside = across_.corners();
  const Outline above = upwards_.corners();
  const Reach across(beside, half * aspect_);
  const Reach upwards(above, half);
  double right = across.middle();
  double up = upwards.middle();
  const double wanted = std::max(across.half_width() / aspect_, upwards.half_width());
  double distance = wanted - std::ranges::min(beside, {}, &glm::dvec2::y).y;
  if (is_parallel) {
    camera.half_height = wanted / kInner;
  } else {
    distance = wanted / half;
    right = centred(right, beside, distance);
    up = centred(up, above, distance);
  }
  camera.eye = origin_ + right * camera.right + up * camera.up - distance * camera.forward;
  return camera;
}

Camera framing_camera(std::span<const Vec3f> points, const View& view, double aspect) {
  Framing framing(view, aspect);
  framing.add(points);
  return framing.camera();
}

}  // namespace isolux
