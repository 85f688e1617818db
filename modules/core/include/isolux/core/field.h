#pragma once

#include <isolux/core/volume.h>

#include <cstdint>
#include <span>

namespace isolux {

/// Which side of a level set is the outside, the side that is lit: that of lower or of higher values.
enum class OuterSide : std::uint8_t { kLower, kHigher };

[[nodiscard]] constexpr OuterSide opposite(OuterSide side) {
  return side == OuterSide::kLower ? OuterSide::kHigher : OuterSide::kLower;
}

/// One of the two sides of a level set. The inner side is the outer one of the same level set with OuterSide turned
/// round: its normal is the other way, and light reaches it through the inside.
enum class LevelSetSide : std::uint8_t { kOuter, kInner };

/// Which gradient gives the shading normal.
enum class GradientKind : std::uint8_t {
  kCentralDifferences,  ///< trilinear interpolation of central differences at the voxels (one-sided on the faces);
                        ///< smooth
  kCell                 ///< the analytic gradient of the trilinear cell (Parker et al. 1998); jumps between cells
};

/// f: the trilinear interpolant of a volume, evaluated in double precision. Positions are in index space and are
/// clamped to the box. A cheap view: copies freely, callable from many threads, does not own the volume. Of values in
/// any of the types of StoredVolume, with the same results. \pre two grid points an axis.
template <class Value>
class TrilinearFieldOf {
 public:
  TrilinearFieldOf(const Lattice& lattice, std::span<const Value> values);

  [[nodiscard]] double value(const Vec3& index) const;
  /// Analytic gradient of the cell holding the point (the lower cell on a shared face), index space.
  [[nodiscard]] Vec3 cell_gradient(const Vec3& index) const;
  /// Interpolated central differences, index space.
  [[nodiscard]] Vec3 smooth_gradient(const Vec3& index) const;
  /// The gradient of `kind` in world space, per world unit.
  [[nodiscard]] Vec3 world_gradient(const Vec3& index, GradientKind kind) const;
  /// The unit normal towards the outer side in world space, or (0,0,0) where there is none: a gradient per index step
  /// of at most 1e-7 of the largest value around is rounding noise of flat data.
  [[nodiscard]] Vec3 normal(const Vec3& index, OuterSide outer, GradientKind kind) const;
  /// The same of a gradient (index space) that is known, where `magnitude` is the largest absolute value around.
  [[nodiscard]] Vec3 normal_of(const Vec3& gradient, double magnitude, OuterSide outer) const;
  /// Smallest and largest value at the corners of the cell that holds the point.
  [[nodiscard]] ValueRange corner_range(const Vec3& index) const;
  /// True if f is constant in every cell that touches the point: its level set there is a solid, not a surface.
  [[nodiscard]] bool is_flat_around(const Vec3& index) const;
  /// Central difference at a grid point along one axis (one-sided on the faces), per index step.
  [[nodiscard]] double difference(int i, int j, int k, int axis) const;

  [[nodiscard]] const Lattice& lattice() const { return lattice_; }
  [[nodiscard]] const Value* data() const { return data_; }

 private:
  struct Place;
  [[nodiscard]] Place place(const Vec3& index) const;

  Lattice lattice_;
  const Value* data_;
  Mat3 gradient_to_world_;
};

/// Of a volume in floats.
class TrilinearField : public TrilinearFieldOf<float> {
 public:
  explicit TrilinearField(const Volume& volume) : TrilinearFieldOf<float>(volume.lattice(), volume.values.values()) {}
  explicit TrilinearField(Volume&& volume) = delete;
};

}  // namespace isolux
