#include <algorithm>
#include <array>
#include <bit>

#include "wide_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide_cells.cpp"
#include <hwy/foreach_target.h>
// After it, as Highway wants.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace isolux::mc {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Numbers of the vertices on a cell's twelve edges, three vectors of four.
constexpr hn::CappedTag<std::uint32_t, 4> kFour;

/// sum[e] = a[e] + b[e] for the twelve edges: left to itself the compiler adds them one by one.
HWY_INLINE void add_twelve(const std::uint32_t* a, const std::uint32_t* b, std::uint32_t* sum) {
  for (std::size_t e = 0; e < 12; e += hn::Lanes(kFour))
    hn::StoreU(hn::Add(hn::LoadU(kFour, a + e), hn::LoadU(kFour, b + e)), kFour, sum + e);
}

/// The numbers that run along a row of cells: the next vertex on each of the rows of grid edges around it, and the next
/// mesh edge on each of its rows of faces and inside.
struct RowCounters {
  std::array<std::uint32_t, 12> vertex;  ///< for each cube edge the next one on its row
  std::uint32_t face_x;
  std::array<std::uint32_t, 2> face_y;
  std::array<std::uint32_t, 2> face_z;
  std::uint32_t inner;
  std::uint32_t triangle;

  HWY_INLINE RowCounters(const MarchState& march, int j, int k) {
    const Counts& lower = march.slabs[k].first;
    const Counts& upper = march.slabs[k + 1].first;
    const Counts* rows = march.slab_rows(k) + j;
    const Counts* upper_rows = march.slab_rows(k + 1) + j;
    const std::uint32_t x[4] = {lower.vertex_x + rows[0].vertex_x, lower.vertex_x + rows[1].vertex_x,
                                upper.vertex_x + upper_rows[0].vertex_x, upper.vertex_x + upper_rows[1].vertex_x};
    const std::uint32_t y[2] = {lower.vertex_y + rows[0].vertex_y, upper.vertex_y + upper_rows[0].vertex_y};
    const std::uint32_t z[2] = {lower.vertex_z + rows[0].vertex_z, lower.vertex_z + rows[1].vertex_z};
    vertex = {x[0], x[1], x[2], x[3], y[0], y[0], y[1], y[1], z[0], z[0], z[1], z[1]};
    face_x = lower.face_x + rows[0].face_x;
    face_y = {lower.face_y + rows[0].face_y, lower.face_y + rows[1].face_y};
    face_z = {lower.face_z + rows[0].face_z, upper.face_z + upper_rows[0].face_z};
    inner = lower.inner + rows[0].inner;
    triangle = lower.triangle + rows[0].triangle;
  }

  /// Vertex numbers of the cell's twelve edges; those not crossed are meaningless.
  HWY_INLINE void vertices(const CellCase& cell, std::uint32_t (&ids)[12]) const {
    add_twelve(vertex.data(), cell.offset.data(), ids);
  }
  /// First half-edge of the cell's six faces and of its inside.
  HWY_INLINE void half_edges(const CellCase& cell, std::uint32_t (&ids)[8]) const {
    ids[0] = 2 * face_x;
    ids[1] = 2 * (face_x + cell.segments[0]);
    for (int r = 0; r < 2; ++r) {
      ids[2 + r] = 2 * face_y[r];
      ids[4 + r] = 2 * face_z[r];
    }
    ids[6] = 2 * inner;
    ids[7] = 0;
  }
  HWY_INLINE void pass_vertices(const CellCase& cell) {
    add_twelve(vertex.data(), cell.step.data(), vertex.data());
    triangle += cell.triangles;
  }
  HWY_INLINE void pass_half_edges(const CellCase& cell) {
    face_x += cell.segments[0];
    for (int r = 0; r < 2; ++r) {
      face_y[r] += cell.segments[2 + r];
      face_z[r] += cell.segments[4 + r];
    }
    inner += cell.inner_edges;
  }
};

/// Calls visit(cell case, counters) for every mixed cell of slab k; visit moves the counters on.
template <class Visit>
void for_each_cell(const MarchState& march, int k, const CaseTable& cases, const Visit& visit) {
  if (k + 1 >= march.nz || march.slabs[k].total.triangle == 0) return;
  const std::uint32_t* active = march.slab_active(k);
  const std::uint32_t count = march.slabs[k].active_words;
  for (std::uint32_t n = 0; n < count;) {
    const int j = row_of(active[n]);
    if (j + 1 >= march.ny) return;
    RowCounters counters(march, j, k);
    const std::uint32_t row_end = pack_word(j + 1, 0);
    for (; n < count && active[n] < row_end; ++n) {
      const int word = word_of(active[n]);
      const WordBits bits(march, j, k, word);
      for (std::uint64_t mixed = bits.mixed(march.cell_mask(word)); mixed != 0; mixed &= mixed - 1)
        visit(cases[bits.corners(std::countr_zero(mixed))], counters);
    }
  }
}

void make_triangles_wide(const MarchState& march, int k, const CaseTable& cases, Triangle* triangles) {
  for_each_cell(march, k, cases, [&](const CellCase& cell, RowCounters& counters) HWY_ATTR {
    std::uint32_t vertices[12];
    counters.vertices(cell, vertices);
    Triangle* out = triangles + counters.triangle;
    for (unsigned t = 0; t < cell.triangles; ++t)
      out[t] = {vertices[cell.vertex[3 * t]], vertices[cell.vertex[3 * t + 1]], vertices[cell.vertex[3 * t + 2]]};
    counters.pass_vertices(cell);
  });
}

void make_half_edges_wide(const MarchState& march, int k, const CaseTable& cases, const HalfEdgeArrays& out) {
  for_each_cell(march, k, cases, [&](const CellCase& cell, RowCounters& counters) HWY_ATTR {
    std::uint32_t vertices[12];
    std::uint32_t first_halves[8];
    counters.vertices(cell, vertices);
    counters.half_edges(cell, first_halves);
    const auto vertex = [&](unsigned corner) HWY_ATTR { return std::int32_t(vertices[cell.vertex[corner]]); };
    const auto half = [&](unsigned corner)
                          HWY_ATTR { return std::int32_t(first_halves[cell.slot[corner]] + cell.half[corner]); };
    for (unsigned t = 0; t < cell.triangles; ++t) {
      const unsigned c = 3 * t;
      const std::int32_t v[3] = {vertex(c), vertex(c + 1), vertex(c + 2)};
      const std::int32_t h[3] = {half(c), half(c + 1), half(c + 2)};
      const std::int32_t face = std::int32_t(counters.triangle + t);
      out.half_edges[h[0]] = {.face = face, .to_vertex = v[1], .next = h[1], .previous = h[2]};
      out.half_edges[h[1]] = {.face = face, .to_vertex = v[2], .next = h[2], .previous = h[0]};
      out.half_edges[h[2]] = {.face = face, .to_vertex = v[0], .next = h[0], .previous = h[1]};
      out.face_half_edge[face] = h[0];
    }
    for (int axis = 0; axis < 3; ++axis)
      if (cell.owned[axis] >= 0) out.vertex_half_edge[vertices[4 * axis]] = half(unsigned(cell.owned[axis]));
    counters.pass_vertices(cell);
    counters.pass_half_edges(cell);
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace isolux::mc
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::mc {

HWY_EXPORT(make_triangles_wide);
HWY_EXPORT(make_half_edges_wide);

void make_triangles(const MarchState& march, int k, const CaseTable& cases, Triangle* triangles) {
  HWY_DYNAMIC_DISPATCH(make_triangles_wide)(march, k, cases, triangles);
}

void make_half_edges(const MarchState& march, int k, const CaseTable& cases, const HalfEdgeArrays& out) {
  HWY_DYNAMIC_DISPATCH(make_half_edges_wide)(march, k, cases, out);
}

}  // namespace isolux::mc
#endif
