#pragma once

#include <isolux/core/vec.h>

namespace isolux {

/// What a diffuse surface does with light.
struct SurfaceColour {
  Vec3f albedo{0.8f};
  Vec3f emission{0.0f};

  /// The radiance that leaves a point with light e = irradiance/pi.
  [[nodiscard]] Vec3f shown(const Vec3f& e) const { return albedo * e + emission; }
};

}  // namespace isolux
