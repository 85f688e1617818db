#pragma once

#include <isolux/core/run.h>
#include <isolux/mc_extract/indexed_mesh.h>

#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <variant>
#include <vector>

#include "level_set.h"

namespace isolux::mc {

/// A vertex of a block on a plane that it shares with the next block.
struct SharedVertex {
  std::size_t edge;  ///< number of the grid edge in its plane
  std::uint32_t id;
};

/// What a block of slabs gives: its part of the mesh, and which of its vertices lie on its first and last plane.
struct SurfaceBlock {
  IndexedMesh mesh;
  std::vector<SharedVertex> bottom;
  std::vector<SharedVertex> top;
};

/// Slabs [first, last) of cells: those between the grid planes `first` and `last`.
struct SlabRange {
  int first;
  int last;
};

/// Collects a level set cell by cell in double precision, slab by slab of a block: the plain way that the scalar
/// backends share. A vertex on a grid edge is made once, whichever cell asks first.
class SurfaceBuilder {
 public:
  SurfaceBuilder(const VolumeView& volume, const ExtractSettings& settings, SlabRange slabs);

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
  [[nodiscard]] float value(const Index3& at) const { return volume_(at.x, at.y, at.z); }
  [[nodiscard]] const Lattice& lattice() const { return lattice_; }
  /// The block so far. Ends the use of the builder.
  [[nodiscard]] SurfaceBlock take() { return std::move(block_); }

 private:
  using Field = std::variant<TrilinearFieldOf<float>, TrilinearFieldOf<std::uint8_t>, TrilinearFieldOf<std::int8_t>,
                             TrilinearFieldOf<std::uint16_t>, TrilinearFieldOf<std::int16_t>>;

  [[nodiscard]] static Field field_of(const VolumeView& volume);
  void classify_plane(int k);
  [[nodiscard]] std::uint32_t push(const Vec3& index, const Vec3& uphill);

  SlabRange slabs_;
  VolumeView volume_;
  Field field_;
  Lattice lattice_;
  LevelSet level_set_;
  Mat3 gradient_to_world_;
  std::array<std::vector<std::uint8_t>, 2> inside_;          ///< of two grid planes, one a point
  std::array<std::vector<std::uint32_t>, 2> edge_vertices_;  ///< the same, 8 directions a point
  SurfaceBlock block_;
};

/// \throw InvalidInput for volumes a plane of which has more grid points than a builder keeps numbers for: 64 bytes
/// each
void require_plane(const Index3& size);

/// Adds what one mixed cell holds, given its inside corners.
using AddCell = std::function<void(SurfaceBuilder& surface, const Index3& cell, int inside)>;

/// The level set of the whole volume, with all that the settings ask for: blocks of slabs in parallel, joined in their
/// order, so that the result does not depend on threads. `add_cell` is called from many threads, once for every cell
/// with corners on both sides. \throw Cancelled.
[[nodiscard]] IndexedMesh build_surface(const VolumeView& volume, const ExtractSettings& settings, const Run& run,
                                        const AddCell& add_cell);

}  // namespace isolux::mc
