#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace isolux::wide {

/// Squared distances rise from class to class, by a sixteenth of an octave from half a bin's side on: they are the
/// upper bits of floats.
inline constexpr int kClassShift = 19;
inline constexpr std::int32_t kFirstClass = (127 - 2) << (23 - kClassShift);
inline constexpr std::int32_t kClasses = 20 << (23 - kClassShift);

[[nodiscard]] inline std::int32_t class_of(float squared_distance) {
  return std::clamp((std::bit_cast<std::int32_t>(squared_distance) >> kClassShift) - kFirstClass, 0, kClasses - 1);
}

}  // namespace isolux::wide
