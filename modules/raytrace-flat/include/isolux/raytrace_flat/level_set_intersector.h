#pragma once

#include <isolux/core/field.h>

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
  ~LevelSetIntersector();
  LevelSetIntersector(const LevelSetIntersector&) = delete;
  LevelSetIntersector& operator=(const LevelSetIntersector&) = delete;

  /// A ray that starts ON the level set {f = isovalue} at `origin` (index space, inside the box): its first root beyond
  /// t = 0, the known root at the start divided out. A direction (index space) straight into the inner side is blocked:
  /// hit at t = 0.
  [[nodiscard]] std::optional<LevelSetHit> next_hit(const Vec3& origin, const Vec3& direction, float isovalue,
                                                    OuterSide outer) const;
  /// A ray from anywhere (a camera): its first root within the box, from either side.
  [[nodiscard]] std::optional<LevelSetHit> first_hit(const Vec3& origin, const Vec3& direction, float isovalue) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace isolux
