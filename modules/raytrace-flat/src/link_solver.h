#pragma once

#include <isolux/raytrace_flat/light_links.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "link_rounds.h"
#include "target_light.h"

namespace isolux {

struct LightLinks::Rounds {
  std::shared_ptr<const LinkTargets> targets;
  std::vector<LinkRound> all;
};

/// All bounces or some of them, from the light without reflections, of all sites or some of them.
class LightLinks::Solver {
 public:
  /// \pre `straight` is e without reflections of all sites, or of those that have a place (kLeftOut: none; empty: all);
  /// everything that is not moved outlives this
  Solver(const LightLinks& links, const Scene& scene, SampleSet straight, std::vector<std::uint32_t> places,
         const ToGrid& to_grid, const Run& run);

  /// Places of one of `one_of` of `count` sites, drawn from each so many that follow each other.
  [[nodiscard]] static std::vector<std::uint32_t> places_of_some(std::size_t count, std::size_t one_of);

  /// The light that the last reflection reads, at the targets; lives as long as this. `start`: of all sites, or none.
  [[nodiscard]] TargetLight before_last(const SolveSettings& settings, std::span<const float> start,
                                        Solution& solution);

 private:
  [[nodiscard]] bool reads_sites() const { return links_.rounds_->targets->are_sites(); }
  /// What a grid is made of: the sites that are solved for.
  void gather_seen(SampleSet straight);
  [[nodiscard]] const std::vector<float>& isovalues() const {
    return reads_sites() ? links_.sites_.isovalues : seen_.sites.isovalues;
  }
  /// Whether some surface gives back nearly all light.
  [[nodiscard]] bool is_nearly_white() const;
  /// What no site's light exceeds, by channel: e_i is what comes straight and at most the part that hits times the most
  /// light there is, so the most is at most the largest of straight_i / (1 - that part). One sweep.
  [[nodiscard]] std::vector<float> most_light();
  /// `light` where it says nothing beyond 0 to `most` (empty: no bound).
  [[nodiscard]] static TargetLight bounded(TargetLight light, const std::vector<float>& most);
  /// Takes `image`, found without acceleration, where this has left e_ outside 0 to `most`.
  void clamp_light(const std::vector<float>& most, const std::vector<float>& image);
  /// The light without reflections and what one reflection of `light` adds, into `next`, whatever it holds.
  void reflect(const TargetLight& light, std::vector<float>& next) const;
  /// As the targets show it. \pre `e` lives as long as what is returned
  [[nodiscard]] TargetLight at_targets(const std::vector<float>& e);
  /// Values and slopes side by side.
  [[nodiscard]] TargetLight sloped(const IlluminationGrid& grid);
  /// Isovalues of the texels, less that of the middle of the sites.
  void measure_texels();

  const LightLinks& links_;
  const Scene& scene_;
  const ToGrid& to_grid_;
  const Run& run_;
  std::vector<std::uint32_t> places_;   ///< of the links' sites among those that are solved for; empty: all
  std::vector<std::uint32_t> numbers_;  ///< of those sites
  std::size_t channels_;
  std::vector<float> straight_;  ///< e without reflections
  SampleSet seen_;               ///< what to_grid_ is shown; empty where sites are read in place
  std::vector<float> e_;         ///< the last iterate
  std::vector<float> light_;     ///< what at_targets() returned
  std::vector<float> texels_;    ///< measure_texels()
  float middle_ = 0.0f;
  std::size_t ends_one_of_ = 1;  ///< SolveSettings
};

}  // namespace isolux
