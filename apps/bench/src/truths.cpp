#include "truths.h"

#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace isolux::bench {

namespace {

/// Whether p lies on a level set of the plane that the closed forms hold for.
bool is_on_plane(const Vec3& p) { return p.z >= 0.02 && p.z <= 0.18 && p.z <= glm::length(p - Vec3(0.5)) - 0.1 - 0.02; }

}  // namespace

Truth plane_under_ball() {
  return {.name = "plane under a ball",
          .field = "ball-over-plane",
          .isovalues = ValueRange{.low = -0.18f, .high = -0.02f},
          .known = is_on_plane,
          .light = [](const Vec3& p) {
            const double height = 0.5 - std::min(p.z, 0.2);
            const double radius = 0.1 + std::min(p.z, 0.2);
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
  // How far the ray towards the sun passes outside the ball of this level set.
  const auto from_edge = [towards](const Vec3& p) {
    const Vec3 to_centre = Vec3(0.5) - p;
    return glm::length(to_centre - glm::dot(to_centre, towards) * towards) - (0.1 + p.z);
  };
  return {.name = "plane in the sun",
          .field = "ball-over-plane",
          .scene = scene,
          .isovalues = ValueRange{.low = -0.18f, .high = -0.02f},
          .known = is_on_plane,
          .light = [from_edge, towards](const Vec3& p) { return from_edge(p) < 0.0 ? 0.0 : towards.z; },
          .edge = [from_edge](const Vec3& p) { return std::fabs(from_edge(p)); }};
}

Truth integrating_sphere() {
  return {.name = "open integrating sphere",
          .field = "cavity",
          .bounces = kAllBounces,
          .isovalues = ValueRange{.low = 0.52f, .high = 0.68f},
          .known =
              [](const Vec3& p) {
                const double radius = glm::length(p - Vec3(0.5));
                return radius >= 0.52 && radius <= 0.68;
              },
          .light =
              [](const Vec3& p) {
                const double open = std::clamp(3.0 * (1.0 - 0.5 / glm::length(p - Vec3(0.5))), 0.0, 1.0);
                return open / (1.0 - 0.8 * (1.0 - open));
              }};
}

Sites all_sites(const Volume& volume, const std::string& sampler, std::size_t count, const SuiteContext& context) {
  return context.stages.samplers.create(sampler)->sample(
      volume, {.texels = cell_lattice(volume.lattice()), .count = count}, context.run);
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
    samples.radiance.push_back(float(truth.light(world) + noise * gauss));
    samples.variance.push_back(float(noise * noise));
  }
  return samples;
}

}  // namespace isolux::bench
