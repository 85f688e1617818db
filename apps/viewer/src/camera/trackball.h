#pragma once

#include <isolux/core/vec.h>
#include <isolux/render/camera.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>

namespace isolux::viewer {

/// A camera that the mouse turns round a point. Places in the picture are 0 in the middle and y upwards.
class Trackball {
 public:
  /// Starts at `home`, turning round `centre`; the object is about `radius` large (world units).
  Trackball(const Camera& home, const Vec3& centre, double radius);

  /// Takes another start, as for a picture of another shape; what the mouse did since the start is kept.
  void reframe(const Camera& home);

  /// Places are -1 to 1 along the picture's shorter side. The object follows the mouse on a virtual ball that fills the
  /// picture: a sphere that goes over into a hyperbolic
  /// sheet, so that the turn is smooth everywhere (Bell, in Henriksen et al., "Virtual trackballs revisited", 2004).
  void rotate(const glm::dvec2& from, const glm::dvec2& to);
  /// Places are -1 to 1 along the picture's height. The point round which the camera turns follows the mouse.
  void pan(const glm::dvec2& from, const glm::dvec2& to);
  /// Goes nearer by 10 % a step (further for negative ones), within 1/50 and 50 times the object's radius.
  void zoom(double steps);
  /// Back to the start.
  void reset();

  [[nodiscard]] Camera camera() const;

 private:
  [[nodiscard]] double home_distance() const;
  [[nodiscard]] double distance() const { return home_distance() / nearness_; }

  Camera home_;
  Vec3 home_target_;
  double radius_;
  Vec3 target_;
  double nearness_ = 1.0;                ///< the start's distance over that now
  glm::dquat turn_{1.0, 0.0, 0.0, 0.0};  ///< from the start's axes, camera space
};

}  // namespace isolux::viewer
