#pragma once

#include <isolux/core/lattice.h>
#include <isolux/render/convex_hull.h>

#include <cstdint>
#include <span>

namespace isolux {

enum class Projection : std::uint8_t {
  kPerspective,  ///< all rays leave the eye
  kOrthographic  ///< rays are parallel: lengths across the view keep their ratio
};

/// A camera in world space.
struct Camera {
  Vec3 eye{0.0};                ///< orthographic: the middle of the plane that rays leave
  Vec3 forward{0.0, 1.0, 0.0};  ///< unit
  Vec3 right{1.0, 0.0, 0.0};    ///< unit
  Vec3 up{0.0, 0.0, 1.0};       ///< unit
  double half_height = 0.25;    ///< tangent of half the vertical angle of view; orthographic: half the picture's height
  Projection projection = Projection::kPerspective;

  /// Direction (unit) through a point of the picture: x from -aspect to aspect (right), y from -1 to 1 (up).
  [[nodiscard]] Vec3 direction(double x, double y) const;
  /// Where the ray through that point begins.
  [[nodiscard]] Vec3 origin(double x, double y) const;
};

/// Which way a picture is taken. Azimuth and elevation 0 look along +y with z up (at a patient's face in LPS space); a
/// rising azimuth walks round `up`, towards +x; elevation 90 looks down.
struct View {
  double azimuth_deg = 30.0;
  double elevation_deg = 20.0;
  /// World space, any length. Azimuth 0 has world x on the right, made perpendicular to `up` (y where `up` is x or -x):
  /// for `up` = y it looks along -z.
  Vec3 up{0.0, 0.0, 1.0};
  Projection projection = Projection::kPerspective;
};

/// Looks at the middle of the volume's box from outside, with the whole box in view. \throw InvalidInput if `up` is not
/// a direction
[[nodiscard]] Camera orbit_camera(const Lattice& volume, const View& view, double aspect);
/// The same in perspective with z up.
[[nodiscard]] Camera orbit_camera(const Lattice& volume, double azimuth_deg, double elevation_deg, double aspect);

/// The nearest camera (the narrowest, if orthographic) that has all these points (world) in view with a margin of a
/// hundredth of the picture's size on each side: they reach it on two opposite sides and are as far from
/// each of the others. Cost: one pass. \throw InvalidInput without points, or if `up` is not a direction
[[nodiscard]] Camera framing_camera(std::span<const Vec3f> points, const View& view, double aspect);

/// The same of points that come bit by bit, such as those of one isosurface after the other. Keeps those alone that may
/// be ends of what is seen: corners of two convex hulls.
class Framing {
 public:
  /// \throw InvalidInput if `up` is not a direction
  Framing(const View& view, double aspect);
  void add(std::span<const Vec3f> points);
  [[nodiscard]] bool empty() const { return across_.empty(); }
  /// \throw InvalidInput without points
  [[nodiscard]] Camera camera() const;

 private:
  Camera turned_;
  double aspect_;
  Vec3 origin_{0.0};    ///< the first point
  ConvexHull across_;   ///< from there, how far to the right and how deep
  ConvexHull upwards_;  ///< how far up and how deep
};

}  // namespace isolux
