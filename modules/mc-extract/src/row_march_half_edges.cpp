// The second half of the way to half-edges: writing what was counted, then those on the box's faces, which no cell
// writes.
#include <isolux/core/parallel.h>

#include "cube.h"
#include "layer_pipeline.h"
#include "row_march.h"

namespace isolux::mc {

namespace {

/// Which side of a face's mesh edges the cells are on.
enum class Side : std::uint8_t { kBelow, kAbove };

/// Segments on the cell face x = i of row (j, k).
std::uint32_t segments_at(const MarchState& march, int i, int j, int k) {
  int inside = 0;
  for (int r = 0; r < 4; ++r)
    inside |= int(march.row_bits(j + (r & 1), k + (r >> 1))[i / 64] >> (i % 64) & 1) << (2 * r);
  return std::uint32_t(face_segments(inside, 0));
}

/// visit(first edge, end edge, side) for the border's edges that the rows of slab k own.
template <class Visit>
void visit_slab(const MarchState& march, int k, const Visit& visit) {
  const Slab& slab = march.slabs[k];
  const Counts& first = slab.first;
  if (k == 0) visit(first.face_z, first.face_z + slab.total.face_z, Side::kAbove);
  if (k + 1 == march.nz) {
    visit(first.face_z, first.face_z + slab.total.face_z, Side::kBelow);
    return;
  }
  const std::uint32_t* active = march.slab_active(k);
  for (std::uint32_t n = 0; n < slab.active_words;) {
    const int j = row_of(active[n]);
    const int first_word = word_of(active[n]);
    while (n < slab.active_words && row_of(active[n]) == j) ++n;
    const int last_word = word_of(active[n - 1]);
    const Counts& start = march.slab_rows(k)[j];
    const Counts& end = n < slab.active_words ? march.slab_rows(k)[row_of(active[n])] : slab.total;
    if (j == 0) visit(first.face_y + start.face_y, first.face_y + end.face_y, Side::kAbove);
    if (j + 1 == march.ny) {
      visit(first.face_y + start.face_y, first.face_y + end.face_y, Side::kBelow);
      continue;
    }
    if (first_word == 0)
      visit(first.face_x + start.face_x, first.face_x + start.face_x + segments_at(march, 0, j, k), Side::kAbove);
    if (last_word == march.words - 1) {
      const std::uint32_t count = segments_at(march, march.nx - 1, j, k);
      visit(first.face_x + end.face_x - count, first.face_x + end.face_x, Side::kBelow);
    }
  }
}

}  // namespace

void RowMarch::link_border(const Run& run, const HalfEdgeArrays& out) const {
  const auto for_each_border_half_edge = [&](const auto& body) {
    parallel_blocks(std::size_t(march_.nz), 64, run, "", [&](const Block& block) {
      for (int k = int(block.begin); k < int(block.end); ++k) {
        visit_slab(march_, k, [&](std::uint32_t begin, std::uint32_t end, Side side) {
          // Of an edge on a face the lower cell has half-edge 0: the border has the other one.
          for (std::uint32_t e = begin; e < end; ++e) body(std::int32_t(2 * e + (side == Side::kBelow ? 1 : 0)));
        });
      }
    });
  };
  for_each_border_half_edge([&](std::int32_t border) {
    const HalfEdgeRecord& inner = out.half_edges[border ^ 1];
    out.half_edges[border].face = -1;
    out.half_edges[border].to_vertex = out.half_edges[inner.previous].to_vertex;
    out.vertex_half_edge[inner.to_vertex] = border;
  });
  // On a manifold one border half-edge leaves each border vertex: the next one.
  for_each_border_half_edge([&](std::int32_t border) {
    const std::int32_t next = out.vertex_half_edge[out.half_edges[border].to_vertex];
    out.half_edges[border].next = next;
    out.half_edges[next].previous = border;
  });
}

void RowMarch::write_half_edges(int layer, const HalfEdgeArrays& out) const {
  const Slabs slabs = slabs_of(layer);
  for (int k = slabs.begin; k < slabs.end; ++k) make_half_edges(march_, k, cases(), out);
}

MeshSize RowMarch::size_up_to(int layer) const {
  const int next = slabs_of(layer).end;
  if (next == march_.nz) return size_;
  const Counts& first = slabs_[std::size_t(next)].first;
  return {.vertices = first.vertex_x, .edges = first.face_x, .triangles = first.triangle};
}

void RowMarch::write(const Run& run, const Fresh& fresh, float* positions, float* normals,
                     const HalfEdgeArrays& out) const {
  const auto write_vertices_of = [&](int layer) {
    if (layer >= layers_with_vertices_) write_vertices(layer, positions, normals);
  };
  if (fresh.reach) {
    const auto nothing = [](int) {};
    LayerPipeline pipeline(layer_count(), {.classify = nothing,
                                           .count =
                                               [&](int layer) {
                                                 const MeshSize before = layer > 0 ? size_up_to(layer - 1) : MeshSize{};
                                                 fresh.bring(before, size_up_to(layer));
                                               },
                                           .number =
                                               [&](int layer) {
                                                 fresh.reach(size_up_to(layer));
                                                 return false;
                                               },
                                           .grow = {},
                                           .write = write_vertices_of,
                                           .connect = [&](int layer) { write_half_edges(layer, out); }});
    pipeline.run(run);
  } else {
    // One after the other: in turn they would drive each other's memory from the cache.
    const auto layers = std::size_t(layer_count());
    parallel_blocks(layers, 1, run, "", [&](const Block& b) { write_vertices_of(int(b.index)); });
    parallel_blocks(layers, 1, run, "", [&](const Block& b) { write_half_edges(int(b.index), out); });
  }
  link_border(run, out);
}

}  // namespace isolux::mc
