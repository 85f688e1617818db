#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/scene.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "link_rounds.h"
#include "ray_values.h"
#include "target_light.h"
#include "wide/aimer.h"

namespace isolux {

/// How the rays of links were aimed.
struct LinkAim {
  std::uint64_t seed = 0;
  std::size_t all_rays = 0;  ///< GatherSettings::all_rays
  RayNets nets = RayNets::kIndependent;
};

/// How many rays each site has.
struct RayCounts {
  std::span<const std::uint32_t> each{};  ///< empty: all have as many
  std::uint32_t same = 0;

  [[nodiscard]] std::uint32_t of(std::size_t site) const { return each.empty() ? same : each[site]; }
};

/// e of sites from what their rays bring, round by round: light that escapes to the environment, emission of what is
/// hit, and what that reflects of the light at the targets. Everything that is given outlives this.
class RaySums {
 public:
  /// `e` may be empty: no reflections. Sites may lack positions and normals (all have one) under a uniform environment.
  /// Sites without a place (kLeftOut; empty: all have one) are left out.
  RaySums(const Volume& volume, const Sites& sites, const Scene& scene, const TargetLight& e, const LinkAim& aim,
          std::span<const std::uint32_t> places = {});

  /// Adds a round that is kept. \throw Cancelled
  void add(const LinkRound& round, const Run& run);
  /// Adds one block of a round, from whatever thread holds it.
  void add(const LinkRound& round, const wide::Aimer& aimer, const LinkBlock& block);
  [[nodiscard]] wide::Aimer aimer(const LinkRound& round) const;

  /// The means, and what comes straight from lamps (which may be empty), without the sites. Of no use afterwards.
  [[nodiscard]] SampleSet means(const RayCounts& rays, const SampleSet& lamps);

 private:
  const Volume& volume_;
  const Sites& sites_;
  RayValues brought_;
  LinkAim aim_;
  std::span<const std::uint32_t> places_;
  std::size_t channels_;
  SampleSet sums_;
};

}  // namespace isolux
