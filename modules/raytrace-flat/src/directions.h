#pragma once

#include <isolux/core/vec.h>

namespace isolux {

/// An orthonormal frame about a direction.
struct Frame {
  Vec3 x;
  Vec3 y;
  Vec3 z;

  [[nodiscard]] Vec3 world(const Vec3& local) const { return local.x * x + local.y * y + local.z * z; }
};

/// The frame whose z axis is the unit vector `axis` (Duff et al., "Building an orthonormal basis, revisited", 2017).
[[nodiscard]] Frame frame_about(const Vec3& axis);

/// A point of the unit square on the unit disc, areas and neighbourhoods kept (Shirley & Chiu 1997).
struct DiscPoint {
  double x;
  double y;
};
[[nodiscard]] DiscPoint disc_point(double u, double v);

/// A direction about +z whose density is its cosine / pi.
[[nodiscard]] Vec3 cosine_direction(double u, double v);

/// A direction about +z, uniform in the cone of solid angle 2 pi one_minus_cosine.
[[nodiscard]] Vec3 cone_direction(double u, double v, double one_minus_cosine);

}  // namespace isolux
