#include "truths.h"

#include <isolux/core/random.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace isolux::bench {

Truth two_balls() {
  return {.name = "two balls",
          .field = "two-spheres",
          .isovalues = ValueRange{.low = -0.19f, .high = -0.06f},
          .e = [](const Vec3& p) -> std::optional<double> {
            const Vec3 left(0.3, 0.5, 0.5);
            const Vec3 right(0.7, 0.5, 0.5);
            const bool on_left = glm::length(p - left) < glm::length(p - right);
            const Vec3 own = on_left ? left : right;
            const Vec3 other = on_left ? right : left;
            const double r = glm::length(p - own);
            if (r < 0.06 || r > 0.19) return std::nullopt;
            const double d = glm::length(other - p);
            const double cosine = glm::dot((p - own) / r, (other - p) / d);
            if (cosine * d >= r) return 1.0 - cosine * (r / d) * (r / d);
            if (cosine * d <= -r) return 1.0;
            return std::nullopt;  // the horizon cuts the other ball
          }};
}

namespace {

/// Height of the level set of the plane through p, if it is one of those that the closed form holds for.
std::optional<double> plane_height(const Vec3& p) {
  if (p.z < 0.02 || p.z > 0.18 || p.z > glm::length(p - Vec3(0.5)) - 0.1 - 0.02) return std::nullopt;
  return p.z;
}

}  // namespace

Truth plane_under_ball() {
  return {.name = "plane under a ball",
          .field = "ball-over-plane",
          .isovalues = ValueRange{.low = -0.18f, .high = -0.02f},
          .e = [](const Vec3& p) -> std::optional<double> {
            const auto z = plane_height(p);
            if (!z) return std::nullopt;
            const double height = 0.5 - *z;
            const double radius = 0.1 + *z;
            const double across = (p.x - 0.5) * (p.x - 0.5) + (p.y - 0.5) * (p.y - 0.5);
            return 1.0 - height * radius * radius / std::pow(height * height + across, 1.5);
          }};
}

Truth plane_in_the_sun() {
  const Vec3 towards = glm::normalize(Vec3(0.3, 0.2, 1.0));
  Scene scene;
  scene.environment = UniformEnvironment{Vec3f(0.0f)};
  scene.lights.emplace_back(SunLight{
      .direction = Vec3f(towards), .irradiance = Vec3f(std::numbers::pi_v<float>), .angular_diameter_deg = 0.0f});
  return {.name = "plane in the sun",
          .field = "ball-over-plane",
          .scene = scene,
          .isovalues = ValueRange{.low = -0.18f, .high = -0.02f},
          .e = [towards](const Vec3& p) -> std::optional<double> {
            const auto z = plane_height(p);
            if (!z) return std::nullopt;
            const Vec3 to_centre = Vec3(0.5) - p;
            const double along = glm::dot(to_centre, towards);
            const bool shaded = glm::length(to_centre - along * towards) < 0.1 + *z;
            return shaded ? 0.0 : towards.z;
          }};
}

Truth integrating_sphere() {
  return {.name = "open integrating sphere",
          .field = "cavity",
          .bounces = kAllBounces,
          .isovalues = ValueRange{.low = 0.52f, .high = 0.68f},
          .e = [](const Vec3& p) -> std::optional<double> {
            const double radius = glm::length(p - Vec3(0.5));
            if (radius < 0.52 || radius > 0.68) return std::nullopt;
            const double open = 3.0 * (1.0 - 0.5 / radius);
            return open / (1.0 - 0.8 * (1.0 - open));
          }};
}

Sites known_sites(const Truth& truth, const Volume& volume, const std::string& sampler, std::size_t count,
                  const SuiteContext& context) {
  const auto backend = context.stages.samplers.create(sampler);
  const Sites all = backend->sample(volume,
                                    {.texels = cell_lattice(volume.lattice()),
                                     .count = count,
                                     .isovalues = truth.isovalues,
                                     .outer = truth.scene.outer},
                                    context.run);
  Sites known;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!truth.e(volume.lattice().frame.world(Vec3(all.positions[i])))) continue;
    known.positions.push_back(all.positions[i]);
    known.isovalues.push_back(all.isovalues[i]);
    known.normals.push_back(all.normals[i]);
  }
  return known;
}

SampleSet exact_samples(const Truth& truth, const Volume& volume, Sites sites, double noise, std::uint64_t seed) {
  SampleSet samples;
  samples.sites = std::move(sites);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    RandomStream random(seed, i, 77);
    // Box & Muller 1958; 1 - u so that the logarithm's argument is never zero.
    const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform_double()));
    const double gauss = radius * std::cos(2.0 * std::numbers::pi * random.uniform_double());
    const Vec3 world = volume.lattice().frame.world(Vec3(samples.sites.positions[i]));
    samples.radiance.push_back(float(truth.e(world).value_or(0.0) + noise * gauss));
    samples.variance.push_back(float(noise * noise));
  }
  return samples;
}

}  // namespace isolux::bench
