#pragma once

#include <isolux/core/vec.h>

#include <array>
#include <optional>

namespace isolux::mc {

/// The topology of the level set {F = 0} of the trilinear interpolant of eight corner values, F >= 0 inside, in the
/// unit cube. Corners as in cube.h.
class TrilinearCell {
 public:
  explicit TrilinearCell(const std::array<double, 8>& corners);

  [[nodiscard]] double value(const Vec3& p) const;
  [[nodiscard]] Vec3 gradient(const Vec3& p) const;

  /// Where the gradient is zero, inside the cell or not: saddles all.
  [[nodiscard]] std::array<std::optional<Vec3>, 2> critical_points() const;

  /// Bit f: whether the inside corners of the ambiguous face f are connected on it, which is where the bilinear saddle
  /// is inside (asymptotic decider, Nielson & Hamann 1991). The two products are the same numbers from both cells.
  [[nodiscard]] int joined_faces() const;

  /// A tunnel: two corners on the same side of the level set that are connected through the cell and not on its
  /// boundary.
  struct Tunnel {
    int from;
    int to;
  };
  /// By Morse theory: F has no extremum inside the cell, so pieces of the inside can only merge there at a saddle with
  /// one ascending direction and F >= 0, and pieces of the outside at one with one descending direction and F < 0. From
  /// either side of such a saddle a way along the axes, on which F is monotone, leads to corners of the pieces that it
  /// joins. Unlike the interior tests of Chernyaev (MC33, 1995; corrected by Custodio et al. 2013) this needs no case
  /// analysis.
  [[nodiscard]] std::optional<Tunnel> tunnel() const;

  /// The six points where the straight lines that the level set holds meet (Grosso 2016), in order: a closed ring on
  /// the surface round the neck of a tunnel. Nothing unless all lie strictly inside the cell.
  [[nodiscard]] std::optional<std::array<Vec3, 6>> hexagon() const;

  /// Corners connected on the cell's boundary, on the same side, have the same number.
  [[nodiscard]] std::array<int, 8> boundary_regions() const;

 private:
  [[nodiscard]] int climb(Vec3 p, double sign) const;
  [[nodiscard]] std::optional<Tunnel> tunnel_at(const Vec3& saddle) const;

  std::array<double, 8> corners_;
  /// F = c[0] + c[1] u + c[2] v + c[3] uv + c[4] w + c[5] uw + c[6] vw + c[7] uvw.
  std::array<double, 8> c_;
};

}  // namespace isolux::mc
