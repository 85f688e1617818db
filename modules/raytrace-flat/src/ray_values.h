#pragma once

#include <isolux/core/vec.h>
#include <isolux/raytrace_flat/scene.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "environment.h"
#include "link_rounds.h"
#include "target_light.h"
#include "wide/hemisphere.h"
#include "wide/net_mean.h"

namespace isolux {

/// What the rays of one site bring, ray by ray.
class RayValues {
 public:
  RayValues(const Scene& scene, const TargetLight& e)
      : scene_(scene),
        e_(e),
        environment_(scene.environment),
        uniform_(std::get_if<UniformEnvironment>(&scene.environment)) {}

  [[nodiscard]] bool wants_directions() const { return uniform_ == nullptr; }

  /// What the site's rays bring together, where it is known without looking at each: light without reflections under a
  /// uniform environment.
  [[nodiscard]] std::optional<wide::NetMean::Moments> moments(const LinkRound& round, const LinkBlock& block,
                                                              std::size_t place, float isovalue) const {
    if (uniform_ == nullptr || !e_.empty()) return std::nullopt;
    const double hits = double(round.hits(block, place));
    const Vec3 sky(uniform_->radiance);
    const Vec3 emission(scene_.emission.at(isovalue));
    return wide::NetMean::Moments{
        .sum = (double(round.rays) - hits) * sky + hits * emission,
        .differences = double(round.changes(block, place)) * (sky - emission) * (sky - emission)};
  }

  /// One value a ray, in round.order. `world` holds the directions of the site's rays where they are wanted.
  void fill(const LinkRound& round, const LinkBlock& block, std::size_t place, float isovalue,
            const wide::Directions& world, std::vector<Vec3>& values) const {
    const Vec3 albedo(scene_.albedo.at(isovalue));
    const Vec3 emission(scene_.emission.at(isovalue));
    const std::uint32_t* target = block.targets.data() + block.begins[place];
    for (std::size_t at = 0; at < round.rays; ++at) {
      if (round.hit(block, place, at)) {
        values[at] = e_.empty() ? emission : emission + albedo * light_at(*target++, isovalue);
      } else if (uniform_ != nullptr) {
        values[at] = Vec3(uniform_->radiance);
      } else {
        const std::uint32_t k = round.order[at];
        values[at] = environment_.radiance({world.axis[0][k], world.axis[1][k], world.axis[2][k]});
      }
    }
  }

 private:
  [[nodiscard]] Vec3 light_at(std::uint32_t target, float isovalue) const {
    if (e_.channels == 1) return Vec3(double(e_.at(target, 0, isovalue)));
    return {e_.at(target, 0, isovalue), e_.at(target, 1, isovalue), e_.at(target, 2, isovalue)};
  }

  const Scene& scene_;
  TargetLight e_;
  PreparedEnvironment environment_;
  const UniformEnvironment* uniform_;
};

}  // namespace isolux
