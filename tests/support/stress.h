// How long the campaigns of the tests run: the environment variable ISOLUX_STRESS.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace isolux::test {

/// ISOLUX_STRESS as a whole number: how many times as much as usual a campaign tries; 1 unless set.
[[nodiscard]] inline int stress() {
  const char* text = std::getenv("ISOLUX_STRESS");
  return text != nullptr ? std::max(1, std::atoi(text)) : 1;
}

/// How often a campaign that may also be shortened tries: ISOLUX_STRESS=.2 is a fifth of the usual.
[[nodiscard]] inline int trials(int usual) {
  const char* text = std::getenv("ISOLUX_STRESS");
  const double times = text != nullptr ? std::atof(text) : 1.0;
  return times > 0.0 ? std::max(1, int(usual * times)) : usual;
}

/// True for ISOLUX_STRESS=full, which asks the oracles' campaigns for all that was ever promised of them.
[[nodiscard]] inline bool full_stress() {
  const char* text = std::getenv("ISOLUX_STRESS");
  return text != nullptr && std::string_view(text) == "full";
}

}  // namespace isolux::test
