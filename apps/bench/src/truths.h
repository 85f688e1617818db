#pragma once

#include <isolux/core/sample_set.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "suite.h"

namespace isolux::bench {

/// A lit analytic field whose e is known at every point of a part of the box (docs/theory.md, "exact answers").
struct Truth {
  std::string name;
  std::string field;  ///< `gen:` name
  Scene scene{};
  int bounces = 0;
  std::optional<ValueRange> isovalues{};       ///< the level sets for which e is known
  std::function<bool(const Vec3&)> known{};    ///< whether `light` is e at this point of [0,1]^3
  std::function<double(const Vec3&)> light{};  ///< e where it is known, its continuation elsewhere
  std::function<double(const Vec3&)> edge{};   ///< distance to the nearest jump of e; empty if it has none

  [[nodiscard]] std::optional<double> e(const Vec3& p) const {
    return known(p) ? std::optional(light(p)) : std::nullopt;
  }
};

/// The plane under a ball in uniform light.
[[nodiscard]] Truth plane_under_ball();
/// The plane under a ball in the sun: a shadow with a sharp edge on every level set.
[[nodiscard]] Truth plane_in_the_sun();
/// The open integrating sphere, albedo .8, all bounces.
[[nodiscard]] Truth integrating_sphere();

/// `count` sites anywhere in the box by `sampler`.
[[nodiscard]] Sites all_sites(const Volume& volume, const std::string& sampler, std::size_t count,
                              const SuiteContext& context);
/// `count` sites of the volume by `sampler`, without those where e is unknown.
[[nodiscard]] Sites known_sites(const Truth& truth, const Volume& volume, const std::string& sampler, std::size_t count,
                                const SuiteContext& context);
/// The light at sites anywhere in the box, with Gaussian noise of this standard deviation, as a tracer would have found
/// it.
[[nodiscard]] SampleSet exact_samples(const Truth& truth, const Volume& volume, Sites sites, double noise,
                                      std::uint64_t seed);

}  // namespace isolux::bench
