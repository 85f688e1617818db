#include "camera/trackball.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace isolux::viewer {
namespace {

Vec3 on_ball(const glm::dvec2& place) {
  const double d2 = glm::dot(place, place);
  return glm::normalize(Vec3(place, d2 <= 0.5 ? std::sqrt(1.0 - d2) : 0.5 / std::sqrt(d2)));
}

}  // namespace

Trackball::Trackball(const Camera& home, const Vec3& centre, double radius)
    : home_(home), home_target_(centre), radius_(radius) {
  reset();
}

void Trackball::reset() {
  target_ = home_target_;
  nearness_ = 1.0;
  turn_ = glm::dquat(1.0, 0.0, 0.0, 0.0);
}

void Trackball::reframe(const Camera& home) { home_ = home; }

double Trackball::home_distance() const { return glm::length(home_target_ - home_.eye); }

void Trackball::rotate(const glm::dvec2& from, const glm::dvec2& to) {
  const Vec3 a = on_ball(from);
  const Vec3 b = on_ball(to);
  const Vec3 axis = glm::cross(a, b);
  const double sine = glm::length(axis);
  if (sine == 0.0) return;
  turn_ = glm::normalize(glm::angleAxis(std::atan2(sine, glm::dot(a, b)), axis / sine) * turn_);
}

void Trackball::pan(const glm::dvec2& from, const glm::dvec2& to) {
  const Camera now = camera();
  const glm::dvec2 move = (to - from) * now.half_height * distance();
  target_ -= move.x * now.right + move.y * now.up;
}

void Trackball::zoom(double steps) {
  const double wanted = std::clamp(distance() * std::pow(0.9, steps), radius_ / 50.0, radius_ * 50.0);
  nearness_ = home_distance() / wanted;
}

Camera Trackball::camera() const {
  // Turning the object by turn_ is turning the camera by its inverse, in the camera's axes at the start.
  const Mat3 start(home_.right, home_.up, -home_.forward);
  const Mat3 axes = start * glm::transpose(glm::mat3_cast(turn_));
  Camera result = home_;
  result.right = axes[0];
  result.up = axes[1];
  result.forward = -axes[2];
  result.eye = target_ - distance() * result.forward;
  return result;
}

}  // namespace isolux::viewer
