#pragma once

#include <isolux/core/vec.h>
#include <isolux/raytrace_flat/scene.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "environment.h"
#include "link_rounds.h"
#include "target_light.h"
#include "wide/hemisphere.h"
#include "wide/net_mean.h"

namespace isolux {

/// What the rays of one site bring.
class RayValues {
 public:
  /// Of the scene's environment and emission, and of the light that their ends reflect (none if empty).
  RayValues(const Scene& scene, const TargetLight& e);

  [[nodiscard]] bool wants_directions() const { return uniform_ == nullptr; }

  /// What a thread keeps between sites.
  struct Scratch {
    explicit Scratch(std::size_t rays);

    std::vector<float> sky[3];        ///< by channel and ray, whether it escapes or not
    std::vector<float> reflected[3];  ///< by channel and target
  };

  /// Where it is known without looking at each ray: light without reflections under a uniform environment.
  [[nodiscard]] std::optional<wide::NetMean::Moments> known_moments(const LinkRound& round, const LinkBlock& block,
                                                                    std::size_t place, float isovalue) const;
  /// `towards`: the directions of the site's rays by axis, where they are wanted; world space.
  [[nodiscard]] wide::NetMean::Moments moments(const LinkRound& round, const LinkBlock& block, std::size_t place,
                                               float isovalue, const std::array<const float*, 3>& towards,
                                               Scratch& scratch) const;

 private:
  void see_sky(const LinkRound& round, const LinkBlock& block, std::size_t place,
               const std::array<const float*, 3>& towards, Scratch& scratch) const;

  const Scene& scene_;
  TargetLight e_;
  EnvironmentView environment_;
  const UniformEnvironment* uniform_;
  const SkyEnvironment* sky_;
  Vec3f up_{0.0f};
};

}  // namespace isolux
