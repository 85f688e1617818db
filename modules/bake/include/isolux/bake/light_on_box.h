#pragma once

#include <isolux/bake/light_points.h>

#include <array>
#include <span>
#include <vector>

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

/// light_on_box() at any place of the faces. Light of lamps is traced at each face's grid points, or 257 an axis where
/// it has more, and read linearly between them; where there are no lamps, once a face. Immutable, callable from many
/// threads.
class BoxLight {
 public:
  /// \throw as light_on_box()
  BoxLight(const Lattice& volume, const Scene& scene, const TraceSettings& settings, const BackendChoice& tracer,
           const Stages& stages, const Run& run);

  /// e at a place (index space of the volume) of a face: 2 axis, + 1 where the index is highest.
  [[nodiscard]] Vec3f at(int face, const Vec3& index) const;
  /// Of what was traced.
  [[nodiscard]] const TraceCounters& counters() const { return counters_; }

 private:
  /// Points of one face, spread evenly from edge to edge.
  struct Face {
    std::array<int, 2> points;
    std::vector<Vec3f> radiance;  ///< the first axis behind the face's own fastest
  };

  Index3 last_;
  std::array<Face, 6> faces_;
  TraceCounters counters_;
};

}  // namespace isolux
