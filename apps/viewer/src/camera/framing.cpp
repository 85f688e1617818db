#include "camera/framing.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace isolux::viewer {

Vec3 box_middle(const Lattice& volume) { return volume.frame.world(0.5 * Vec3(volume.size - 1)); }

double box_radius(const Lattice& volume) {
  const Vec3 middle = box_middle(volume);
  double radius = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Index3 far_side(corner & 1, corner >> 1 & 1, corner >> 2);
    radius = std::max(radius, glm::length(volume.frame.world(Vec3(far_side * (volume.size - 1))) - middle));
  }
  return radius;
}

glm::dmat4 clip_from_centred(const Camera& camera, const Vec3& centre, double radius, double aspect) {
  const Vec3 eye = camera.eye - centre;
  const double distance = glm::length(eye);
  // A ten-thousandth of the far plane still leaves 24 bits of depth some thousand steps across the object.
  const double far_plane = distance + radius;
  const double near_plane = std::max(distance - radius, 1e-4 * far_plane);
  // Not glm::lookAt(eye, eye + forward): far eyes, in small world units, round the sum to the eye.
  const Mat3 turn = glm::transpose(Mat3(camera.right, camera.up, -camera.forward));
  glm::dmat4 view(turn);
  view[3] = glm::dvec4(-(turn * eye), 1.0);
  return glm::perspective(2.0 * std::atan(camera.half_height), aspect, near_plane, far_plane) * view;
}

}  // namespace isolux::viewer
