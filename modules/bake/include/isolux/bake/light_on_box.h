#pragma once

#include <isolux/bake/light_points.h>

#include <span>

namespace isolux {

/// Rays of light from far away, for each normal that differs from the others.
inline constexpr int kRaysANormal = 1 << 14;

/// e = irradiance/pi at world positions on the faces of a volume's box, seen from outside: on caps (cap_vertices.h).
/// The box is convex, so that nothing in it stands before an outward face: it is lit by the scene's environment and
/// lights alone. `normals` (world, unit, one a position) point out of the box; few differ. What comes from far away
/// (environment, suns) costs kRaysANormal rays for each that does, what comes from lamps settings.rays for each
/// position. \throw as bake(); InvalidInput unless there is a normal for each position
[[nodiscard]] PointLight light_on_box(const Lattice& volume, const Scene& scene, std::span<const Vec3f> positions,
                                      std::span<const Vec3f> normals, const TraceSettings& settings,
                                      const BackendChoice& tracer, const Stages& stages, const Run& run);

}  // namespace isolux
