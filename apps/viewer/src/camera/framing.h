#pragma once

#include <isolux/core/lattice.h>
#include <isolux/render/camera.h>

#include <glm/mat4x4.hpp>

namespace isolux::viewer {

/// The middle of the volume's box, world space, and the distance from it to the farthest corner.
[[nodiscard]] Vec3 box_middle(const Lattice& volume);
[[nodiscard]] double box_radius(const Lattice& volume);

/// From world positions relative to `centre` to OpenGL's clip space; everything within `radius` of the centre is
/// between the near and the far plane, as far as it is before the camera.
[[nodiscard]] glm::dmat4 clip_from_centred(const Camera& camera, const Vec3& centre, double radius, double aspect);

}  // namespace isolux::viewer
