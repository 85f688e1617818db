#pragma once

#include <cstdint>
#include <vector>

namespace isolux {

/// Which sites take so many rays to a sun: those near the edges of its shadows. The others know from a few.
struct SunQuestions {
  std::vector<bool> asked;  ///< of each site
  int rays = 0;
};

/// How many rays each site has of each light.
struct SiteRays {
  std::vector<std::uint32_t> sky;  ///< empty: all as many
  std::vector<SunQuestions> suns;  ///< of those of the scene's lights; empty: all sites take as many
};

}  // namespace isolux
