#pragma once

#include <isolux/raytrace_flat/light_links.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "link_rounds.h"
#include "target_light.h"

namespace isolux {

struct LightLinks::Rounds {
  std::shared_ptr<const LinkTargets> targets;
  std::vector<LinkRound> all;
};

/// All bounces or some of them, from the light without reflections.
class LightLinks::Solver {
 public:
  Solver(const LightLinks& links, const Scene& scene, const SampleSet& straight, const ToGrid& to_grid, const Run& run)
      : links_(links), scene_(scene), straight_(straight), to_grid_(to_grid), run_(run), seen_(straight) {}

  /// The light that the last reflection reads, at the targets; lives as long as this.
  [[nodiscard]] TargetLight before_last(const SolveSettings& settings, std::span<const float> start,
                                        Solution& solution);

 private:
  [[nodiscard]] bool reads_sites() const { return links_.rounds_->targets->are_sites(); }
  /// The light without reflections and what one reflection of `e` adds.
  [[nodiscard]] std::vector<float> reflect(const std::vector<float>& e);
  /// As the targets show it. \pre `e` lives as long as what is returned
  [[nodiscard]] TargetLight at_targets(const std::vector<float>& e);
  /// Values and slopes side by side.
  [[nodiscard]] TargetLight sloped(const IlluminationGrid& grid);
  /// Isovalues of the texels, less that of the middle of the sites.
  void measure_texels();

  const LightLinks& links_;
  const Scene& scene_;
  const SampleSet& straight_;
  const ToGrid& to_grid_;
  const Run& run_;
  SampleSet seen_;             ///< what to_grid_ is shown
  std::vector<float> e_;       ///< the last iterate
  std::vector<float> light_;   ///< what at_targets() returned
  std::vector<float> texels_;  ///< measure_texels()
  float middle_ = 0.0f;
};

}  // namespace isolux
