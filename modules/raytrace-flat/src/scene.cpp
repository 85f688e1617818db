#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat/scene.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string_view>

#include "environment.h"

namespace isolux {
namespace {

bool is_grey_colour(const Vec3f& c) { return c.x == c.y && c.y == c.z; }

bool is_grey_colour(const IsovalueColour& colour) {
  return std::all_of(colour.keys.begin(), colour.keys.end(),
                     [](const auto& key) { return is_grey_colour(key.colour); });
}

bool is_grey_environment(const Environment& environment) {
  if (const auto* uniform = std::get_if<UniformEnvironment>(&environment)) return is_grey_colour(uniform->radiance);
  if (const auto* sky = std::get_if<SkyEnvironment>(&environment))
    return is_grey_colour(sky->zenith) && is_grey_colour(sky->horizon) && is_grey_colour(sky->ground);
  const auto& pixels = std::get<ImageEnvironment>(environment).pixels;
  return std::all_of(pixels.begin(), pixels.end(), [](const Vec3f& c) { return is_grey_colour(c); });
}

bool is_grey_light(const Light& light) {
  if (const auto* sun = std::get_if<SunLight>(&light)) return is_grey_colour(sun->irradiance);
  if (const auto* rectangle = std::get_if<RectangleLight>(&light)) return is_grey_colour(rectangle->radiance);
  return is_grey_colour(std::get<SphereLight>(light).radiance);
}

bool is_finite(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void require_colour(std::string_view what, const Vec3f& c, float most) {
  for (int a = 0; a < 3; ++a) {
    if (std::isfinite(c[a]) && c[a] >= 0.0f && c[a] <= most) continue;
    if (std::isfinite(most)) throw InvalidInput(fmt::format("{} = {}: allowed is 0 to {}", what, c[a], most));
    throw InvalidInput(fmt::format("{} = {}: allowed is a finite number of at least 0", what, c[a]));
  }
}

void require_direction(std::string_view what, const Vec3f& v) {
  const double length = glm::length(Vec3(v));
  if (!is_finite(v) || !(length > 0.0))
    throw InvalidInput(fmt::format("{} = {},{},{}: allowed is any direction but 0,0,0", what, v.x, v.y, v.z));
}

void require_place(std::string_view what, const Vec3& v) {
  // Within a float's range, so that squares of distances stay in a double's.
  if (!is_finite(Vec3f(v)))
    throw InvalidInput(fmt::format("{} = {},{},{}: allowed are numbers within +-{:.2g}", what, v.x, v.y, v.z,
                                   double(std::numeric_limits<float>::max())));
}

void require_keys(std::string_view what, const IsovalueColour& colour, float most) {
  if (colour.keys.empty()) throw InvalidInput(fmt::format("{} has no keys; it needs at least one", what));
  for (std::size_t i = 0; i < colour.keys.size(); ++i) {
    require_colour(what, colour.keys[i].colour, most);
    if (!std::isfinite(colour.keys[i].isovalue))
      throw InvalidInput(fmt::format("{}: an isovalue is not a finite number", what));
    if (i > 0 && !(colour.keys[i - 1].isovalue < colour.keys[i].isovalue)) {
      throw InvalidInput(fmt::format("{}: isovalue {} stands after {}; they must rise", what, colour.keys[i].isovalue,
                                     colour.keys[i - 1].isovalue));
    }
  }
}

constexpr float kAnyBrightness = std::numeric_limits<float>::infinity();

void require_valid_environment(const Environment& environment) {
  if (const auto* uniform = std::get_if<UniformEnvironment>(&environment)) {
    require_colour("environment radiance", uniform->radiance, kAnyBrightness);
  } else if (const auto* sky = std::get_if<SkyEnvironment>(&environment)) {
    require_direction("sky up", sky->up);
    require_colour("sky zenith", sky->zenith, kAnyBrightness);
    require_colour("sky horizon", sky->horizon, kAnyBrightness);
    require_colour("sky ground", sky->ground, kAnyBrightness);
  } else if (const auto* image = std::get_if<ImageEnvironment>(&environment)) {
    require_direction("environment image up", image->up);
    require_pixels(*image);
    for (const Vec3f& c : image->pixels) require_colour("environment image pixel", c, kAnyBrightness);
  }
}

void require_valid_light(const Light& light) {
  if (const auto* sun = std::get_if<SunLight>(&light)) {
    require_direction("sun direction", sun->direction);
    require_colour("sun irradiance", sun->irradiance, kAnyBrightness);
    if (!(sun->angular_diameter_deg >= 0.0f && sun->angular_diameter_deg <= kWidestSun)) {
      throw InvalidInput(
          fmt::format("sun angular_diameter_deg = {}: allowed is 0 to {}", sun->angular_diameter_deg, kWidestSun));
    }
  } else if (const auto* rectangle = std::get_if<RectangleLight>(&light)) {
    require_place("rectangle center", rectangle->center);
    require_colour("rectangle radiance", rectangle->radiance, kAnyBrightness);
    require_direction("rectangle u", rectangle->u);
    require_direction("rectangle v", rectangle->v);
    if (!(glm::length(glm::cross(Vec3(rectangle->u), Vec3(rectangle->v))) > 0.0))
      throw InvalidInput("rectangle u and v are parallel; they must span an area");
  } else if (const auto* sphere = std::get_if<SphereLight>(&light)) {
    require_place("sphere center", sphere->center);
    require_colour("sphere radiance", sphere->radiance, kAnyBrightness);
    if (!(std::isfinite(sphere->radius) && sphere->radius > 0.0f))
      throw InvalidInput(fmt::format("sphere radius = {}: allowed is a finite number above 0", sphere->radius));
  }
}

}  // namespace

void require_pixels(const ImageEnvironment& image) {
  if (image.width >= 1 && image.height >= 1 &&
      image.pixels.size() == std::size_t(image.width) * std::size_t(image.height))
    return;
  throw InvalidInput(
      fmt::format("an environment image of {}x{} with {} pixels; it needs width times height, one at least",
                  image.width, image.height, image.pixels.size()));
}

Vec3f IsovalueColour::at(float isovalue) const {
  const auto above = std::upper_bound(keys.begin(), keys.end(), isovalue,
                                      [](float value, const Key& key) { return value < key.isovalue; });
  if (above == keys.begin()) return keys.front().colour;
  if (above == keys.end()) return keys.back().colour;
  const Key& low = *(above - 1);
  const double s = (double(isovalue) - double(low.isovalue)) / (double(above->isovalue) - double(low.isovalue));
  return Vec3f((1.0 - s) * Vec3(low.colour) + s * Vec3(above->colour));
}

float largest_albedo(const Scene& scene) {
  float most = 0.0f;
  for (const auto& key : scene.albedo.keys) most = std::max({most, key.colour.x, key.colour.y, key.colour.z});
  return most;
}

bool has_emission(const Scene& scene) {
  return std::any_of(scene.emission.keys.begin(), scene.emission.keys.end(),
                     [](const auto& key) { return key.colour != Vec3f(0.0f); });
}

float largest_radiance(const Environment& environment) {
  const auto largest = [](const Vec3f& c) { return std::max({c.x, c.y, c.z}); };
  if (const auto* uniform = std::get_if<UniformEnvironment>(&environment)) return largest(uniform->radiance);
  if (const auto* sky = std::get_if<SkyEnvironment>(&environment))
    return std::max({largest(sky->zenith), largest(sky->horizon), largest(sky->ground)});
  float most = 0.0f;
  for (const Vec3f& pixel : std::get<ImageEnvironment>(environment).pixels) most = std::max(most, largest(pixel));
  return most;
}

Scene scene_of_side(Scene scene, LevelSetSide side) {
  scene.sides = LitSides::kOuter;
  if (side == LevelSetSide::kInner) scene.outer = opposite(scene.outer);
  return scene;
}

bool is_grey(const Scene& scene) {
  return is_grey_environment(scene.environment) &&
         std::all_of(scene.lights.begin(), scene.lights.end(), is_grey_light) && is_grey_colour(scene.albedo) &&
         is_grey_colour(scene.emission);
}

Vec3f environment_radiance(const Environment& environment, const Vec3& towards) {
  if (const auto* image = std::get_if<ImageEnvironment>(&environment)) require_pixels(*image);
  return Vec3f(EnvironmentView(environment).radiance(towards));
}

void require_valid(const Scene& scene) {
  require_valid_environment(scene.environment);
  for (const Light& light : scene.lights) require_valid_light(light);
  require_keys("albedo", scene.albedo, 1.0f);
  require_keys("emission", scene.emission, kAnyBrightness);
}

}  // namespace isolux
