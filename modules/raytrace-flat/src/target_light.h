#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace isolux {

/// e at the targets of links: a target's channels, and behind them, where light changes with the isovalue, as many
/// slopes. Owns nothing.
struct TargetLight {
  std::span<const float> values{};
  std::size_t channels = 1;
  bool sloped = false;
  float isovalue = 0.0f;  ///< at which values are e itself
  /// By channel, what no light exceeds: a slope leads beyond what there is.
  std::array<float, 3> most = {kNoBound, kNoBound, kNoBound};

  static constexpr float kNoBound = std::numeric_limits<float>::max();

  [[nodiscard]] bool empty() const { return values.empty(); }
  [[nodiscard]] std::size_t stride() const { return sloped ? 2 * channels : channels; }
  /// As seen along the level set of an isovalue.
  [[nodiscard]] float at(std::uint32_t target, std::size_t channel, float level) const {
    const float* e = &values[target * stride()];
    if (!sloped) return e[channel];
    return std::clamp(e[channel] + e[channels + channel] * (level - isovalue), 0.0f, most[channel]);
  }
};

}  // namespace isolux
