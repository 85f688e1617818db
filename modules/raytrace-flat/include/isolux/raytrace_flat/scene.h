#pragma once

#include <isolux/core/field.h>
#include <isolux/core/vec.h>

#include <cstdint>
#include <variant>
#include <vector>

namespace isolux {

/// The same radiance from everywhere.
struct UniformEnvironment {
  Vec3f radiance{1.0f};
};

/// Zenith blends to horizon by the sine of the elevation above the plane of `up`; below it is ground.
struct SkyEnvironment {
  Vec3f up{0.0f, 0.0f, 1.0f};
  Vec3f zenith{1.0f};
  Vec3f horizon{1.0f};
  Vec3f ground{0.0f};
};

/// A latitude-longitude image: row 0 towards `up`, linear radiance, RGB, x fastest; read bilinearly, wrapping from side
/// to side. The middle between the left and the right edge shows world direction x, made perpendicular to `up` (y where
/// `up` is x or -x); columns turn to the right as seen from within, with `up` upwards: for up = z the image shows, from
/// left to right, -x, y, x, -y, -x. An empty image is an error.
struct ImageEnvironment {
  Vec3f up{0.0f, 0.0f, 1.0f};
  int width = 0;
  int height = 0;
  std::vector<Vec3f> pixels;
};

using Environment = std::variant<UniformEnvironment, SkyEnvironment, ImageEnvironment>;

inline constexpr float kWidestSun = 90.0f;  ///< SunLight::angular_diameter_deg at most

/// Parallel light from a disc in the sky. `irradiance` is at normal incidence.
struct SunLight {
  Vec3f direction{0.0f, 0.0f, 1.0f};  ///< towards the sun, world space, any length
  Vec3f irradiance{1.0f};
  float angular_diameter_deg = 0.53f;
};

/// center +- u +- v, shining on the side of cross(u, v).
struct RectangleLight {
  Vec3 center{0.0};  ///< of as many digits as a volume's origin: lamp and volume move together
  Vec3f u{1.0f, 0.0f, 0.0f};
  Vec3f v{0.0f, 1.0f, 0.0f};
  Vec3f radiance{1.0f};
};

/// A ball that shines outwards.
struct SphereLight {
  Vec3 center{0.0};
  float radius = 1.0f;
  Vec3f radiance{1.0f};
};

using Light = std::variant<SunLight, RectangleLight, SphereLight>;

/// A colour as a function of the isovalue: piecewise linear between keys, constant beyond them.
struct IsovalueColour {
  struct Key {
    float isovalue;
    Vec3f colour;
  };
  std::vector<Key> keys;  ///< by rising isovalue, at least one

  [[nodiscard]] Vec3f at(float isovalue) const;
};

/// Which sides of the level sets a bake lights.
enum class LitSides : std::uint8_t { kOuter, kBoth };

/// What lights the level sets and how they reflect. Lengths in world units.
struct Scene {
  Environment environment{UniformEnvironment{}};
  std::vector<Light> lights;  ///< shine at any number of bounces, are not seen as geometry, block nothing
  IsovalueColour albedo{{{0.0f, Vec3f(0.8f)}}};
  IsovalueColour emission{{{0.0f, Vec3f(0.0f)}}};
  OuterSide outer = OuterSide::kLower;
  LitSides sides = LitSides::kOuter;  ///< of bake() alone: tracers, links and points take the outer side
};

/// The scene that lights one side of these level sets as its outer side.
[[nodiscard]] Scene scene_of_side(Scene scene, LevelSetSide side);

/// True if every colour of the scene is grey: then one channel is enough.
[[nodiscard]] bool is_grey(const Scene& scene);

/// Of all isovalues and channels.
[[nodiscard]] float largest_albedo(const Scene& scene);

/// Whether level sets shine by themselves.
[[nodiscard]] bool has_emission(const Scene& scene);

/// Of all directions and channels.
[[nodiscard]] float largest_radiance(const Environment& environment);

/// Whether light is aimed at: light sources, or parts of an image that are many times brighter than the rest. \throw
/// InvalidInput for images without pixels
[[nodiscard]] bool has_lamps(const Scene& scene);

/// \throw InvalidInput, naming what and why, for colours that are negative or not finite, albedos above 1, keys that do
/// not rise, directions and areas of length zero, and images without pixels.
void require_valid(const Scene& scene);

/// Radiance that arrives from world direction `towards` (unit) where nothing is in the way, light sources apart. \throw
/// InvalidInput for images without pixels
[[nodiscard]] Vec3f environment_radiance(const Environment& environment, const Vec3& towards);

}  // namespace isolux
