#pragma once

#include <isolux/core/field.h>

#include <array>
#include <optional>

namespace isolux::mc {

/// Voxels an axis that a polynomial goes through.
struct Stencil {
  int off_grid;  ///< for a coordinate between grid points: even, as many on either side
  int on_grid;   ///< for one at a grid point: odd
  int on_face;   ///< the same where the box does not hold as many on either side
};

/// The gradient of the tensor product of interpolating polynomials through the voxels nearest to a point, of an order
/// as high as the data bear. After Fornberg, "Generation of finite difference formulas on arbitrarily spaced grids"
/// (1988): on a grid line it is the interpolation of central differences of that order. Callable from many threads.
template <class Value>
class HighOrderGradient {
 public:
  /// Coordinates closer to a grid point's than `tolerance` of their axis count as its.
  HighOrderGradient(const TrilinearFieldOf<Value>& field, const Vec3& tolerance);

  /// Index space, per index step; none where the data are too rough for more than central differences, or not finite.
  [[nodiscard]] std::optional<Vec3> at(const Vec3& index) const;
  [[nodiscard]] bool is_grid_point(const Vec3& index) const;

 private:
  /// Weights of a coordinate's value and derivative, of `count` grid points from `first` on.
  struct Weights;
  /// How much of the higher orders to take, 0 to 1: over central differences, and of the second stencil over the first.
  struct Smoothness {
    double first = 0.0;
    double second = 0.0;
  };

  [[nodiscard]] Smoothness smoothness(const Vec3& index) const;
  [[nodiscard]] Weights weights(double x, int axis, const Stencil& stencil) const;
  [[nodiscard]] Vec3 gradient(const Vec3& index, const Stencil& stencil) const;

  TrilinearFieldOf<Value> field_;
  Index3 size_;
  Vec3 tolerance_;
};

}  // namespace isolux::mc
