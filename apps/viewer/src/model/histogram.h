#pragma once

#include <isolux/core/volume.h>

#include <array>
#include <cstdint>

namespace isolux::viewer {

/// How often values occur: 256 equal steps from the smallest to the largest; a single value is in the middle.
struct Histogram {
  static constexpr int kSteps = 256;
  ValueRange range;
  std::array<std::uint64_t, kSteps> counts{};
};

/// \pre require_usable(volume). Cost: two passes.
[[nodiscard]] Histogram make_histogram(const VolumeView& volume);

/// The isovalue that parts the values best into two classes (Otsu, "A threshold selection method from gray-level
/// histograms", 1979); for a constant volume its value.
[[nodiscard]] double otsu_threshold(const Histogram& histogram);

}  // namespace isolux::viewer
