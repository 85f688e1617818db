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

/// A triangle on the unit sphere to draw directions in.
class SphericalTriangle {
 public:
  SphericalTriangle() = default;
  /// Corners are unit vectors.
  SphericalTriangle(const Vec3& a, const Vec3& b, const Vec3& c);

  [[nodiscard]] double area() const { return area_; }
  /// A direction uniform in the triangle (Arvo, "Stratified sampling of spherical triangles", 1995).
  [[nodiscard]] Vec3 direction(double u, double v) const;

 private:
  Vec3 a_{0.0};
  Vec3 b_{0.0};
  Vec3 aside_{0.0};  ///< unit, at right angles to a, on the great circle to c
  double area_ = 0.0;
  double angle_ = 0.0;  ///< at a
  double cosine_ab_ = 0.0;
};

/// A light source as it is seen from one point, made ready for many draws.
class LightView {
 public:
  /// A way from the point to the light, by two numbers in [0, 1); none where the light does not shine.
  [[nodiscard]] std::optional<LightSample> sample(double u, double v) const;

 private:
  friend class PreparedLight;
  struct Dark {};
  struct Cone {
    Frame frame;
    double one_minus_cosine;
    Vec3 weight;
    double distance;  ///< of the ball's centre; infinite for a sun
    double radius;
  };
  struct Quad {
    Vec3 center;  ///< from the point
    Vec3 u;
    Vec3 v;
    Vec3 normal;
    double height;  ///< of the point over the plane
    double area;
    Vec3 radiance;
    SphericalTriangle halves[2];
  };
  [[nodiscard]] static LightSample drawn(const Cone& cone, double u, double v);
  [[nodiscard]] static LightSample drawn(const Quad& quad, double u, double v);

  std::variant<Dark, Cone, Quad> shape_;
};

/// A light source made ready to be looked at from many points. A sun and a sphere are drawn uniformly in the cone of
/// directions that they fill, a rectangle uniformly in its solid angle (two spherical triangles, Arvo 1995), or by area
/// where that is so small that the two are the same: the estimate stays bounded however near the light is. A sphere
/// light shines outwards only: not at points within.
class PreparedLight {
 public:
  explicit PreparedLight(const Light& light);

  /// From a point of world space.
  [[nodiscard]] LightView from(const Vec3& point) const;

 private:
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
  static LightView view(const LightView::Cone& sun, const Vec3& point);
  static LightView view(const Parallelogram& light, const Vec3& point);
  static LightView view(const Ball& light, const Vec3& point);

  std::variant<LightView::Cone, Parallelogram, Ball> shape_;
};

}  // namespace isolux
