#pragma once

#include <isolux/bake/bake.h>
#include <isolux/core/run.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "texel_site_maker.h"

namespace isolux {

/// Places whose light is traced to judge what was found there otherwise and never used for it: traced twice by paths,
/// with other random numbers. Paths have no bias, so the mean product of both differences is the mean squared error
/// whatever is wrong with the light, be it how reflections were read. What paths that were cut off (TraceResult::cut)
/// would still have brought is known to lie in a range, where the environment alone shines, and light within it counts
/// as right; places of which that is much, or not known, are left out.
class HeldOut {
 public:
  /// Of the light to judge, site i is number `numbers[i]`. \throw Cancelled
  HeldOut(const Volume& volume, const Scene& scene, const Sites& sites, std::vector<std::size_t> numbers,
          const TraceSettings& settings, const Run& run);

  struct SquaredError {
    double mean = 0.0;            ///< below 0 by chance alone; 0 if nothing is held out
    double standard_error = 0.0;  ///< of the mean, as the places are few and their light is noisy
  };
  /// Of light with the scene's channels.
  [[nodiscard]] SquaredError squared_error(std::span<const float> light) const;
  [[nodiscard]] std::span<const std::size_t> numbers() const { return numbers_; }
  [[nodiscard]] std::size_t left_out() const { return left_out_; }
  [[nodiscard]] const TraceCounters& counters() const { return counters_; }

 private:
  /// Places whose paths say too little.
  void leave_out(const std::vector<std::uint8_t>& is_known);

  std::vector<std::size_t> numbers_;
  std::array<std::vector<float>, 2> light_;
  std::array<std::vector<float>, 2> beyond_;  ///< of each place, by what cut paths may have missed light
  std::size_t left_out_ = 0;
  TraceCounters counters_;
};

/// Counts what judging took, and the places that it had to leave out.
void count_judging(const HeldOut& held_out, BakeResult& result);

/// Texels to hold out, drawn at random, all that can be lit being equally likely: at most so many, or one of `one_of`.
/// \throw Cancelled
[[nodiscard]] std::vector<std::size_t> held_out_texels(const Lattice& texels, const TexelSiteMaker& sites,
                                                       std::size_t most, std::size_t one_of, const Run& run);

/// To judge a bake of `sites` sites: by how many places, if there are so many, all paths together being some twentieth
/// of the time of a large one.
[[nodiscard]] std::size_t places_to_judge_by(std::size_t sites, const Scene& scene, const BakeSettings& settings);
/// By what paths of each of `places` places: fewer places are lit by the more of them.
[[nodiscard]] TraceSettings paths_of_each(std::size_t places, std::size_t sites, const Scene& scene,
                                          const BakeSettings& settings);

/// One number of each of `shares` equal shares of those below `count`. \pre shares <= count
[[nodiscard]] std::vector<std::size_t> one_of_each_share(std::size_t count, std::size_t shares, const Run& run);

}  // namespace isolux
