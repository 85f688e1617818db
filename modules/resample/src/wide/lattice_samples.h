#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sample_window.h"
#include "wide/stencil.h"

namespace isolux::wide {

/// Samples at the points of a lattice, one at most, in the order of its memory, and what the denoiser asks of each: its
/// look. Of the coordinates that light is fitted over, three are the sample's place.
struct LatticeSamples {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::size_t kPlaces = 3;
  // Of a look.
  static constexpr std::size_t kIsovalue = 0;
  static constexpr std::size_t kNormal = 1;
  static constexpr std::size_t kOpenness = 4;
  static constexpr std::size_t kFitted = 7;  ///< numbers that are coordinates
  static constexpr std::size_t kVariance = 7;
  static constexpr std::size_t kLight = 8;

  std::array<int, 3> size{0, 0, 0};
  std::vector<std::uint32_t> at;  ///< the sample of each point, or kNone
  Stencil stencil;                ///< its unit of length is that of isovalues, too
  std::size_t channels = 1;       ///< 1 or 3
  SampleWindow<float> looks;      ///< one after the other, in whole fours

  [[nodiscard]] static constexpr std::size_t stride(std::size_t channels) { return (kLight + channels + 3) / 4 * 4; }
  [[nodiscard]] const float* look(std::size_t sample) const { return looks.of(sample); }
  [[nodiscard]] float* look(std::size_t sample) { return looks.of(sample); }
  /// Where a row of points along x begins.
  [[nodiscard]] std::size_t row(int y, int z) const {
    return (std::size_t(z) * std::size_t(size[1]) + std::size_t(y)) * std::size_t(size[0]);
  }
};

}  // namespace isolux::wide
