#include <isolux/render/camera.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace isolux {

Vec3 Camera::direction(double x, double y) const {
  return glm::normalize(forward + half_height * (x * right + y * up));
}

Camera orbit_camera(const Lattice& volume, double azimuth_deg, double elevation_deg, double aspect) {
  const Vec3 last(volume.size - 1);
  const Vec3 middle = volume.frame.world(0.5 * last);
  const double azimuth = glm::radians(azimuth_deg);
  const double elevation = glm::radians(elevation_deg);
  Camera camera;
  camera.right = {std::cos(azimuth), std::sin(azimuth), 0.0};
  const Vec3 level(-std::sin(azimuth), std::cos(azimuth), 0.0);
  camera.forward = std::cos(elevation) * level - Vec3(0.0, 0.0, std::sin(elevation));
  camera.up = glm::cross(camera.right, camera.forward);
  // The nearest eye that has every corner of the box within the picture.
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index((corner & 1) * last.x, (corner >> 1 & 1) * last.y, (corner >> 2) * last.z);
    const Vec3 p = volume.frame.world(index) - middle;
    const double across = std::max(std::fabs(glm::dot(p, camera.right)) / aspect, std::fabs(glm::dot(p, camera.up)));
    distance = std::max(distance, across / camera.half_height - glm::dot(p, camera.forward));
  }
  camera.eye = middle - camera.forward * distance;
  return camera;
}

}  // namespace isolux
