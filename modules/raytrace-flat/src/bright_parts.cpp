#include "bright_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "environment.h"

namespace isolux {
namespace {

/// Times the mean luminance: what is brighter is aimed at. Below it, rays by chance are off by no more than under a sky
/// of which a quarter shines.
constexpr double kBright = 4.0;

/// Of the whole sphere.
double mean_luminance(const ImageEnvironment& image) {
  double sum = 0.0;
  double weights = 0.0;
  for (int row = 0; row < image.height; ++row) {
    const double weight = std::sin((row + 0.5) / image.height * std::numbers::pi);
    double of_row = 0.0;
    for (int column = 0; column < image.width; ++column)
      of_row += luminance(image.pixels[std::size_t(row) * std::size_t(image.width) + std::size_t(column)]);
    sum += weight * of_row;
    weights += weight * image.width;
  }
  return sum / weights;
}

/// Of colours brighter than that there are bright parts; infinite where there are none.
double most_of_soft(const Environment& environment) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto* image = std::get_if<ImageEnvironment>(&environment);
  if (image == nullptr) return kNone;
  require_pixels(*image);
  const double most = kBright * mean_luminance(*image);
  const bool any = std::any_of(image->pixels.begin(), image->pixels.end(),
                               [most](const Vec3f& pixel) { return luminance(pixel) > most; });
  return any ? most : kNone;
}

Scene under(Environment environment, const Scene& scene) {
  return {.environment = std::move(environment),
          .lights = scene.lights,
          .albedo = scene.albedo,
          .emission = scene.emission,
          .outer = scene.outer,
          .sides = scene.sides};
}

}  // namespace

SceneParts::SceneParts(const Scene& scene) : whole_(scene) {
  const double most = most_of_soft(scene.environment);
  if (std::isinf(most)) return;
  const auto& image = std::get<ImageEnvironment>(scene.environment);
  ImageEnvironment soft = image;
  ImageEnvironment bright = image;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double here = luminance(image.pixels[i]);
    if (here > most) soft.pixels[i] *= float(most / here);
    bright.pixels[i] -= soft.pixels[i];
  }
  bright_ = std::move(bright);
  soft_ = under(std::move(soft), scene);
}

Scene lamps_of(const Scene& scene) {
  Scene lamps = under(UniformEnvironment{Vec3f(0.0f)}, scene);
  lamps.emission = {.keys = {{0.0f, Vec3f(0.0f)}}};
  return lamps;
}

bool has_lamps(const Scene& scene) { return !scene.lights.empty() || !std::isinf(most_of_soft(scene.environment)); }

}  // namespace isolux
