#pragma once

#include <isolux/bake/bake.h>

#include <cstddef>
#include <optional>

#include "held_out.h"

namespace isolux {

/// Whether a texel's light is that of its one site, so that its error is the site's.
[[nodiscard]] bool are_sites_own(const Resampler& resampler, const BakeSettings& settings);

/// Finds what light is wrong by where it is read, if that is not its sites' own error: noise that averages out over
/// many sites, and what lies between them. Some texels, of a small grid all, are lit by paths; of known isovalues
/// points of their level sets.
class TexelJudge {
 public:
  /// For a bake of so many sites. \throw Cancelled
  TexelJudge(const Volume& volume, const Scene& scene, const BakeSettings& settings, std::size_t sites, const Run& run);

  /// False where hardly any place can be lit.
  [[nodiscard]] bool can_judge() const;
  /// Of light on the texels that `settings` name, of the scene's outer side; none where it cannot judge.
  [[nodiscard]] std::optional<HeldOut::SquaredError> squared_error(const IlluminationGrid& light, const Run& run) const;
  [[nodiscard]] const HeldOut& held_out() const { return held_out_; }

 private:
  const Volume& volume_;
  Sites places_;
  HeldOut held_out_;
};

/// Sets result.rmse_estimate and the scale of result.error.
void tell_error(const std::optional<HeldOut::SquaredError>& error, BakeResult& result);

/// Judges the light of a bake, adds rays and seconds. \throw Cancelled
void judge_texels(const Volume& volume, const Scene& scene, const BakeSettings& settings, const Run& run,
                  BakeResult& result);

}  // namespace isolux
