#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace isolux {

/// e at the targets of links: a target's channels, and behind them, where light changes with the isovalue, as many
/// slopes. Owns nothing.
struct TargetLight {
  std::span<const float> values{};
  std::size_t channels = 1;
  bool sloped = false;
  float isovalue = 0.0f;  ///< at which values are e itself

  [[nodiscard]] bool empty() const { return values.empty(); }
  [[nodiscard]] std::size_t stride() const { return sloped ? 2 * channels : channels; }
  /// As seen along the level set of an isovalue.
  [[nodiscard]] float at(std::uint32_t target, std::size_t channel, float level) const {
    const float* e = &values[target * stride()];
    return sloped ? e[channel] + e[channels + channel] * (level - isovalue) : e[channel];
  }
};

}  // namespace isolux
