#pragma once

#include <isolux/raytrace_flat/scene.h>

#include <optional>
#include <variant>

#include "directions.h"

namespace isolux {

/// A way towards a light source, drawn at random.
struct LightSample {
  Vec3 towards{0.0};      ///< world space, unit
  double distance = 0.0;  ///< to the light, world units; infinite for a sun
  Vec3 weight{0.0};       ///< radiance / density per solid angle: its mean over draws is the integral of the radiance
};

/// The disc that a sun fills in the sky.
struct SunDisc {
  double one_minus_cosine;  ///< of the angle between its middle and its edge
  Vec3 weight;              ///< LightSample::weight of directions that are even in it
};
[[nodiscard]] SunDisc sun_disc(const SunLight& sun);

/// A light source made ready for many draws.
class PreparedLight {
 public:
  explicit PreparedLight(const Light& light);

  /// A way from a point (world space) to the light, by two numbers in [0, 1); none where the light does not shine.
  /// A sun and a sphere are drawn uniformly in the cone of directions that they fill, a rectangle uniformly in its
  /// solid angle (two spherical triangles, Arvo 1995), or by area where that is so small that the two are the same: the
  /// estimate stays bounded however near the light is. A sphere light shines outwards only: not at points within.
  [[nodiscard]] std::optional<LightSample> sample(const Vec3& from, double u, double v) const;

 private:
  struct Cone {
    Frame frame;
    SunDisc disc;
  };
  struct Parallelogram {
    Vec3 center;
    Vec3 u;
    Vec3 v;
    Vec3 normal;  ///< unit
    double area;
    Vec3 radiance;
  };
  struct Ball {
    Vec3 center;
    double radius;
    Vec3 radiance;
  };
  static std::optional<LightSample> sample_shape(const Cone& sun, const Vec3& from, double u, double v);
  static std::optional<LightSample> sample_shape(const Parallelogram& light, const Vec3& from, double u, double v);
  static std::optional<LightSample> sample_shape(const Ball& light, const Vec3& from, double u, double v);

  std::variant<Cone, Parallelogram, Ball> shape_;
};

}  // namespace isolux
