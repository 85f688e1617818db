#pragma once

#include <isolux/core/run.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "texel_site_maker.h"

namespace isolux {

/// Texels whose light is traced to judge a prediction and never used for it: drawn at random, traced twice by paths
/// with other random numbers. Paths have no bias, so the mean product of both differences is the mean squared error
/// whatever is wrong with the light, be it how reflections were read.
class HeldOut {
 public:
  /// At most 6,144 texels, or one of eight. \throw Cancelled
  HeldOut(const Volume& volume, const Scene& scene, const Lattice& texels, const TexelSiteMaker& sites,
          const TraceSettings& settings, const Run& run);

  struct SquaredError {
    double mean = 0.0;            ///< at least the standard error: few texels can agree by chance
    double standard_error = 0.0;  ///< of the mean, as the texels are few and their light is noisy
  };
  /// Of light at all texels, the scene's channels each.
  [[nodiscard]] SquaredError squared_error(std::span<const float> light) const;
  [[nodiscard]] const TraceCounters& counters() const { return counters_; }

 private:
  void draw(const Lattice& texels, const TexelSiteMaker& sites, const Run& run);

  std::vector<std::size_t> texels_;
  std::array<std::vector<float>, 2> light_;
  TraceCounters counters_;
};

}  // namespace isolux
