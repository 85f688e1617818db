#pragma once

#include <isolux/core/field.h>

#include <limits>
#include <memory>
#include <optional>

namespace isolux {

/// A place where a ray meets a level set.
struct LevelSetHit {
  double t = 0.0;      ///< along the ray, in lengths of its direction
  Vec3 position{0.0};  ///< index space
};

/// Finds where rays meet level sets of a volume: exact roots of the trilinear interpolant along the ray, cell by cell
/// over a min/max macrocell hierarchy, in double precision. The scalar oracle of everything faster. Immutable, callable
/// from many threads; the volume must outlive it.
class LevelSetIntersector {
 public:
  explicit LevelSetIntersector(const Volume& volume);
  explicit LevelSetIntersector(Volume&& volume) = delete;
  ~LevelSetIntersector();
  LevelSetIntersector(const LevelSetIntersector&) = delete;
  LevelSetIntersector& operator=(const LevelSetIntersector&) = delete;

  /// A ray that starts ON a level set at `origin` (index space, inside the box): its first root beyond t = 0, met from
  /// the outer side; the known root at the start is divided out. A direction (index space, any length) straight into
  /// the inner side is blocked: hit at t = 0. The level set is the one through `origin` itself, {f = f(origin)} in
  /// double precision, of which `isovalue` is the rounded name, so that no ray starts beside its surface; where
  /// f(origin) is `isovalue` to double precision it is {f = isovalue}. A ray that runs in the level set meets it where
  /// it turns into the inner side, or returns.
  [[nodiscard]] std::optional<LevelSetHit> next_hit(const Vec3& origin, const Vec3& direction, float isovalue,
                                                    OuterSide outer) const;
  /// Whether next_hit has a hit at t <= limit; does not refine the root: a shadow ray.
  [[nodiscard]] bool is_occluded(const Vec3& origin, const Vec3& direction, float isovalue, OuterSide outer,
                                 double limit = std::numeric_limits<double>::infinity()) const;
  /// A ray from anywhere (a camera): its first root within the box, from either side; t = 0 if it starts on one.
  [[nodiscard]] std::optional<LevelSetHit> first_hit(const Vec3& origin, const Vec3& direction, float isovalue) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace isolux
