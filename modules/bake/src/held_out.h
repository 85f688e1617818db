#pragma once

#include <isolux/raytrace_flat/light_links.h>
#include <isolux/raytrace_flat/trace_counters.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "texel_site_maker.h"

namespace isolux {

/// Texels whose light is traced to judge a prediction and never used for it: drawn at random, traced twice with other
/// random numbers, so that the mean product of both differences is the mean squared error whatever is wrong with it.
class HeldOut {
 public:
  /// At most 6,144 texels, or one of eight. \pre the volume outlives this \throw Cancelled
  HeldOut(const Volume& volume, const Lattice& texels, const TexelSiteMaker& sites, const LinkSettings& links,
          const Run& run);

  [[nodiscard]] bool empty() const { return texels_.empty(); }

  /// Of light at all texels, the scene's channels each; what is reflected is read from it too, so with `bounces` every
  /// texel has to be filled.
  [[nodiscard]] double squared_error(const Scene& scene, std::span<const float> light, const SolveSettings& settings,
                                     const Run& run);
  void add_counters(TraceCounters& sum) const {
    for (const auto& links : links_) add(sum, links->counters());
  }

 private:
  void draw(const Lattice& texels, const TexelSiteMaker& sites, const Run& run);

  std::vector<std::size_t> texels_;
  std::array<std::unique_ptr<LightLinks>, 2> links_;
  std::array<std::vector<float>, 2> straight_;  ///< light without reflections
};

}  // namespace isolux
