#pragma once

#include <isolux/core/vec.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

namespace isolux {

/// The affine map from index space (grid points at integers) to world space.
struct IndexToWorld {
  Vec3 origin{0.0};  ///< world position of grid point (0,0,0)
  Mat3 axes{1.0};    ///< axes[a]: world step from one grid point to the next on axis a (direction times spacing)

  [[nodiscard]] Vec3 world(const Vec3& index) const { return origin + axes * index; }
  [[nodiscard]] Vec3 index(const Vec3& world) const;
  /// A covector (a gradient) from index space to world space: the inverse transpose of `axes`.
  [[nodiscard]] Mat3 gradient_to_world() const;
  /// Length of each axis' step, world units.
  [[nodiscard]] Vec3 spacing() const;
};

/// A regular grid of points: sizes along x, y, z (x fastest in memory) and where they lie.
struct Lattice {
  Index3 size{0};
  IndexToWorld frame;

  [[nodiscard]] std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
  [[nodiscard]] std::size_t offset(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size.y) + std::size_t(j)) * std::size_t(size.x) + std::size_t(i);
  }
};

/// The place on an axis of `points` grid points within the box: clamped to 0 to points - 1; 0 for what is no number.
[[nodiscard]] inline double within_axis(double place, int points) {
  return place > 0.0 ? std::min(place, double(points - 1)) : 0.0;
}

/// The number, in the order of memory, of the point of `lattice` that lies at a place of its index space: within a
/// hundredth of a step on each axis, which float positions are off by less than up to some 10,000 voxels an axis.
/// Nothing if there is none.
[[nodiscard]] std::optional<std::size_t> point_at(const Lattice& lattice, const Vec3& index);

/// \throw InvalidInput, naming `what`, unless the axes span a volume: numbers whose determinant is not 0, with lengths
/// that can be told from it
void require_spanning(const IndexToWorld& frame, std::string_view what);
/// \throw InvalidInput, naming `what`, unless a grid point's place in the world, from the origin, gives the point back
/// to a thousandth of a step: an axis may be 1e20 times shorter than the others along the world's axes, not across them
void require_places(const Lattice& lattice, std::string_view what);
/// lattice.count(). \throw InvalidInput for sizes below 0 and more points than memory can be asked for (2^48)
[[nodiscard]] std::size_t require_countable(const Lattice& lattice);
/// \throw InvalidInput unless there is one value a point
void require_values(const Lattice& lattice, std::size_t values);

/// `texels` texel centres spread over the box of `volume`: centre i of N lies at (i + 0.5)/N between the first and the
/// last grid point. With n - 1 texels on each axis they are the cell centres. Texture coordinate = place in the box, 0
/// to 1. \throw InvalidInput unless the volume has two grid points and the texture one texel on each axis.
[[nodiscard]] Lattice cell_lattice(const Lattice& volume, Index3 texels);
/// The same with one texel a cell.
[[nodiscard]] Lattice cell_lattice(const Lattice& volume);
/// Texels at the grid points themselves (the thesis); `volume` unchanged. Texture coordinate of the point at place u in
/// the box of an axis with n points: (u (n - 1) + 0.5)/n.
[[nodiscard]] Lattice voxel_lattice(const Lattice& volume);

/// The affine map from `from`'s index space to `to`'s index space. Along axes that both share it has no rounding of the
/// others': grid points of `voxel_lattice` are the volume's, as floats, however oblique the axes are.
[[nodiscard]] IndexToWorld index_to_index(const Lattice& from, const Lattice& to);
/// Whether each axis runs along the other's axis of the same number, but for rounding.
[[nodiscard]] bool has_axes_of(const Lattice& one, const Lattice& other);

}  // namespace isolux
