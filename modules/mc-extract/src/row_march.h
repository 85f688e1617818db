#pragma once

#include <isolux/mc_extract/extractor.h>
#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/mc_extract/large_vector.h>

#include <optional>
#include <vector>

#include "brick_index.h"
#include "march_state.h"
#include "wide_kernels.h"

namespace isolux::mc {

/// How much there is of each kind in the mesh.
struct MeshSize {
  std::size_t vertices = 0;
  std::size_t edges = 0;
  std::size_t triangles = 0;
};

/// Marching cubes by rows, slab by slab in parallel: bits, counts, running sums, then vertices and connectivity
/// straight to their places. Numbers do not depend on threads: they follow the grid.
class RowMarch {
 public:
  /// \throw InvalidInput for volumes whose planes are beyond 32-bit offsets.
  explicit RowMarch(const Volume& volume);

  /// First half: what there is. Uses `index` if given.
  [[nodiscard]] MeshSize count(const ExtractSettings& settings, const Run& run, const BrickIndex* index,
                               Connectivity connectivity);
  /// Second half, after count() with the same settings.
  void write_vertices(const Run& run, float* positions, float* normals) const;
  void write_triangles(const Run& run, Triangle* triangles) const;
  /// After count() with Connectivity::kHalfEdges.
  void write_half_edges(const Run& run, const HalfEdgeArrays& out) const;

 private:
  void classify_all(const Run& run);
  void classify_active(const ExtractSettings& settings, const Run& run, const BrickIndex& index);
  void classify_brick_row(const ExtractSettings& settings, const BrickIndex& index, int row, int layer);
  void count_active(const Run& run, const BrickIndex* index, Connectivity connectivity);
  [[nodiscard]] MeshSize number_slabs();
  [[nodiscard]] std::uint8_t activity(int word, int row, int layer) const;
  void link_border(const Run& run, const HalfEdgeArrays& out) const;

  Lattice lattice_;
  MarchState march_;
  VertexFrame frame_{};
  bool mirrored_ = false;
  LargeVector<std::uint64_t> bits_;
  LargeVector<Counts> rows_;
  LargeVector<std::uint32_t> active_;
  std::vector<Slab> slabs_;
  std::vector<std::uint8_t> activity_;  ///< [layers][rows][words]: see BrickIndex::find_active
  int brick_rows_ = 0;
};

}  // namespace isolux::mc
