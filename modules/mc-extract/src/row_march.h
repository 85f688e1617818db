#pragma once

#include <isolux/mc_extract/extractor.h>
#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/mc_extract/large_vector.h>

#include <functional>
#include <optional>
#include <vector>

#include "active_words.h"
#include "brick_index.h"
#include "march_state.h"
#include "wide_kernels.h"

namespace isolux::mc {

/// \throw InvalidInput if a mesh would have more than 2^31 triangle corners or half-edges.
void require_countable(const MeshSize& size, float isovalue);

/// Marching cubes by rows: bits, counts, running sums, then vertices and connectivity straight to their places, in
/// parallel by slabs and layers of four slabs. Numbers do not depend on threads: they follow the grid. With an index
/// the volume is read only where the level set is, unless that is in so many bricks that reading all is quicker.
class RowMarch {
 public:
  /// Where more of the bricks hold both sides, the index saves nothing: bits by bricks cost more than by rows. On the
  /// gyroid of 256^3 the two ways meet at a share of 0.1 to 0.2.
  static constexpr double kDense = 0.2;

  /// With a share of mixed bricks above `dense` the volume is read whole, index or not.
  /// \throw InvalidInput for volumes whose planes are beyond 32-bit offsets.
  explicit RowMarch(const VolumeView& volume, double dense = kDense);

  /// The whole way, a few layers at a time, so that values and bits are still in the cache where they are used again.
  /// The mesh's memory is used again and grows as needed.
  void march(const ExtractSettings& settings, const Run& run, const BrickIndex* index, IndexedMesh& mesh);

  /// How a mesh that does not hold all of it yet gets there, layer by layer. Empty: it does.
  struct Fresh {
    std::function<void(const MeshSize& before, const MeshSize& after)> bring;  ///< any layers at once, before `reach`
    std::function<void(const MeshSize& size)> reach;  ///< one call at a time, before more than that is written
  };

  /// For half-edges, whose kernel takes its size beforehand. First half: what there is, and the vertices of the layers
  /// that fit `room`, while their values are in the cache.
  [[nodiscard]] MeshSize count(const ExtractSettings& settings, const Run& run, const BrickIndex* index,
                               const VertexRoom& room);
  /// Second half: the other vertices and the half-edges. The first vertices are where count() wrote them, or what it
  /// wrote was copied.
  void write(const Run& run, const Fresh& fresh, float* positions, float* normals, const HalfEdgeArrays& out) const;

 private:
  /// Slabs [begin, end): a grid plane and what it owns each.
  struct Slabs {
    int begin;
    int end;
  };
  void begin(const ExtractSettings& settings, const Run& run, const BrickIndex* index);
  // A layer is as many slabs as a brick is high.
  [[nodiscard]] int layer_count() const;
  [[nodiscard]] Slabs slabs_of(int layer) const;
  void classify_layer(int layer);
  void classify_brick_row(int row, int layer);
  void count_layer(int layer, Connectivity connectivity);
  /// Gives the slabs their first numbers: layers in rising order.
  void number_layer(int layer);
  void write_vertices(int layer, float* positions, float* normals) const;
  void write_half_edges(int layer, const HalfEdgeArrays& out) const;
  /// What the layers up to this one hold.
  [[nodiscard]] MeshSize size_up_to(int layer) const;
  [[nodiscard]] const CaseTable& cases() const;
  void link_border(const Run& run, const HalfEdgeArrays& out) const;

  Lattice lattice_;
  double dense_;
  MarchState march_;
  VertexFrame frame_{};
  bool mirrored_ = false;
  LargeVector<std::uint64_t> bits_;
  LargeVector<Counts> rows_;
  LargeVector<std::uint32_t> active_;
  std::vector<Slab> slabs_;
  ExtractSettings settings_;
  const BrickIndex* index_ = nullptr;  ///< where the sparse way is taken
  ActiveWords active_words_;
  MeshSize size_;
  int layers_with_vertices_ = 0;  ///< the first ones, which count() wrote
};

}  // namespace isolux::mc
