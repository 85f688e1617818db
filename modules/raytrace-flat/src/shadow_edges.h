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

struct ShadowEdges {
  std::vector<bool> near;            ///< for each site
  std::vector<std::uint32_t> alone;  ///< sites that saw a part, where all about them saw all, or all saw none
};

/// Which sites may see a part of the lamp only: those that saw so, those with both sites that saw all of it and sites
/// that saw none close by, those whose horizon cuts it, and those with too few sites about them to tell. Close by is
/// within the aligned cubes about a site that hold some twenty sites on average. As many as are found alone may have
/// been missed, as the rays of such a site fall on one side of an edge as easily as on both.
[[nodiscard]] ShadowEdges find_shadow_edges(const Sites& sites, std::span<const LampSeen> seen);

}  // namespace isolux
