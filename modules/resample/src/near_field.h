#pragma once

#include <isolux/core/field.h>
#include <isolux/core/illumination_grid.h>
#include <isolux/core/sample_set.h>

#include <span>

namespace isolux {

/// How open a level set is in front of its points, told by the volume alone: where f, a step away along the normal, has
/// gone on as the gradient says, nothing is near; where it has turned back, a wall is. Cheap to evaluate anywhere, it
/// carries the variation of light that is finer than texels (a control variate), as `vicinity shading` (Stewart,
/// "Vicinity shading for enhanced perception of volumetric data", VIS 2003) does on its own.
class NearField {
 public:
  explicit NearField(const Volume& volume);

  /// One mean grid spacing towards lower values, in index space, and by how much f falls over it as the gradient says.
  struct Ahead {
    Vec3 step{0.0};
    Vec3 downhill{0.0};  ///< the same way in world space, of length one; zero where there is no gradient
    double fall = 0.0;   ///< 0 where there is no gradient
  };
  [[nodiscard]] Ahead ahead(const Vec3& index) const;
  /// The same of a gradient in index space (interpolated central differences).
  [[nodiscard]] Ahead ahead_of(const Vec3& gradient) const;
  /// -1 (closed) to 1 (open) at a point of index space; 0 where there is no gradient. `step` as in NearFieldTerm.
  [[nodiscard]] float openness(const Vec3& index, const Ahead& ahead, double isovalue, double step) const;
  /// The same where f `there`, at index + step * ahead.step, is known. \pre ahead.fall > 0
  [[nodiscard]] static float openness_of(double there, const Ahead& ahead, double isovalue, double step);
  /// The sign of steps towards the outer side: the sites' normals know which that is.
  [[nodiscard]] double outwards(const Sites& sites) const;
  [[nodiscard]] const TrilinearField& field() const { return field_; }

 private:
  TrilinearField field_;
  Mat3 gradient_to_world_;
  Mat3 world_to_index_;
  double spacing_;  ///< geometric mean, world units
};

/// The most that a place may weigh where `weights` are roots of the field's steepness: twice what nine in ten do
/// not exceed. A spike of the volume, thousands of times as steep as the rest, would otherwise be all that counts.
[[nodiscard]] float most_weight(std::span<const float> weights);

}  // namespace isolux
