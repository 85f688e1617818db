#pragma once

#include <isolux/core/sample_set.h>

#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// What a few rays of a site saw of a lamp.
enum class LampSeen : std::uint8_t {
  kTurnedAway,  ///< no ray is worth anything
  kNone,
  kAll,
  kSome,
  kRising  ///< the site's own horizon cuts the lamp
};

/// Which sites may see a part of the lamp only: those that saw so, those with both sites that saw all of it and sites
/// that saw none close by, those whose horizon cuts it, and those with too few sites about them to tell. Close by is
/// within the aligned cubes about a site that hold some twenty sites on average.
[[nodiscard]] std::vector<bool> near_shadow_edges(const Sites& sites, std::span<const LampSeen> seen);

}  // namespace isolux
