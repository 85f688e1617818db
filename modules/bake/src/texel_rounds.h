#pragma once

#include <limits>
#include <optional>

#include "texel_judge.h"
#include "texel_target.h"

namespace isolux {

/// Rounds of rays towards an error of texels that are made of several sites each.
struct TexelRounds {
  TexelJudge judge;
  TexelTarget target;
  std::optional<HeldOut::SquaredError> error = {};  ///< of the light that was judged last; none where it cannot be
  /// The sites' squared noise at which the texels are worth making.
  double wanted = std::numeric_limits<double>::infinity();
  bool is_lit = false;  ///< whether that is the light of all rays so far
};

}  // namespace isolux
