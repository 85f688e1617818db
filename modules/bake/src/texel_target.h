#pragma once

#include <vector>

#include "held_out.h"

namespace isolux {

/// How many rays an error asked of texels is worth where these are made of several sites each. What texels are wrong by
/// is noise, which falls with that of the sites, and what no ray takes away: light between the sites, or how
/// reflections are read. Denoised texels are in between: with less noise less is averaged. Rounds of rays tell how fast
/// it falls.
class TexelTarget {
 public:
  explicit TexelTarget(double target_rmse) : target_(target_rmse * target_rmse) {}

  /// Squares after one round: mean noise of the sites, and error of the texels.
  void add(double sites, const HeldOut::SquaredError& texels) { rounds_.push_back({sites, texels}); }

  /// \pre a round was added
  [[nodiscard]] bool is_reached() const;
  /// Whether it is missed and no rays are worth it.
  [[nodiscard]] bool is_beyond_rays() const { return !rounds_.empty() && !is_reached() && wanted_noise() == 0.0; }
  /// The squared noise of the sites that rays are worth: less than that of the last round, or 0 where more of them are
  /// worth nothing. \pre a round was added
  [[nodiscard]] double wanted_noise() const;

 private:
  struct Round {
    double sites = 0.0;
    HeldOut::SquaredError texels;
  };
  /// Of the sites' squared noise that the texels' squared error falls as; the most it can be as long as that is not
  /// known.
  [[nodiscard]] double power() const;

  double target_;
  std::vector<Round> rounds_;
};

}  // namespace isolux
