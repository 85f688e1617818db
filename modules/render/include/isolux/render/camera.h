#pragma once

#include <isolux/core/lattice.h>

namespace isolux {

/// A perspective camera in world space.
struct Camera {
  Vec3 eye{0.0};
  Vec3 forward{0.0, 1.0, 0.0};  ///< unit
  Vec3 right{1.0, 0.0, 0.0};    ///< unit
  Vec3 up{0.0, 0.0, 1.0};       ///< unit
  double half_height = 0.25;    ///< tangent of half the vertical angle of view

  /// Direction (unit) through a point of the picture: x from -aspect to aspect (right), y from -1 to 1 (up).
  [[nodiscard]] Vec3 direction(double x, double y) const;
};

/// Looks at the middle of the volume's box from outside, with z up and the whole box in view. Azimuth 0 and elevation 0
/// looks along +y (at a patient's face in LPS space); a rising azimuth walks round towards +x; degrees.
[[nodiscard]] Camera orbit_camera(const Lattice& volume, double azimuth_deg, double elevation_deg, double aspect);

}  // namespace isolux
