#pragma once

#include <isolux/mc_extract/indexed_mesh.h>

#include <array>
#include <cstddef>
#include <vector>

#include "level_set.h"

namespace isolux::mc {

/// Collects a level set cell by cell in double precision, slab by slab: the plain way that the scalar backends share. A
/// vertex on a grid edge is made once, whichever cell asks first.
class SurfaceBuilder {
 public:
  SurfaceBuilder(const Volume& volume, const ExtractSettings& settings);

  /// Before the cells between grid planes k and k + 1, in rising order.
  void begin_slab(int k);
  /// Bit c is set where corner c of the cell is inside.
  [[nodiscard]] int inside_corners(const Index3& cell) const;
  /// The vertex on the grid edge from grid point `low` to `low + direction bits` (1 to 7: x, y, z and the diagonals).
  [[nodiscard]] std::uint32_t edge_vertex(const Index3& low, int direction);
  /// A vertex anywhere, index space.
  [[nodiscard]] std::uint32_t add_vertex(const Vec3& index);
  /// Counter-clockwise from the outer side in index space; turned round where the frame mirrors.
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  [[nodiscard]] const LevelSet& level_set() const { return level_set_; }
  [[nodiscard]] float value(const Index3& at) const { return field_.data()[lattice_.offset(at.x, at.y, at.z)]; }
  [[nodiscard]] const Lattice& lattice() const { return lattice_; }
  /// The mesh so far, with all that the settings ask for. Ends the use of the builder.
  [[nodiscard]] IndexedMesh take();

 private:
  [[nodiscard]] std::uint32_t push(const Vec3& index, const Vec3& uphill);

  const Volume& volume_;
  ExtractSettings settings_;
  TrilinearField field_;
  Lattice lattice_;
  LevelSet level_set_;
  Mat3 gradient_to_world_;
  std::array<std::vector<std::uint32_t>, 2> edge_vertices_;  ///< of two grid planes, 8 directions a point
  IndexedMesh mesh_;
};

}  // namespace isolux::mc
