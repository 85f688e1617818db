#include <algorithm>
#include <array>
#include <cstddef>

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

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2  // wider targets have lower numbers

constexpr hn::FixedTag<std::uint32_t, 8> kEight;
using Eight = hn::Vec<decltype(kEight)>;

HWY_INLINE Eight load(const std::uint32_t* from) { return hn::LoadU(kEight, from); }
HWY_INLINE Eight load(const std::uint8_t* from) {
  return hn::PromoteTo(kEight, hn::LoadU(hn::FixedTag<std::uint8_t, 8>(), from));
}
HWY_INLINE Eight add(Eight a, Eight b) { return hn::Add(a, b); }
HWY_INLINE void store(Eight v, std::uint32_t* to) { hn::StoreU(v, kEight, to); }
/// from[places]: places below 8.
HWY_INLINE Eight pick(Eight from, Eight places) {
  return hn::TableLookupLanes(from, hn::IndicesFromVec(kEight, places));
}
/// The same of sixteen numbers.
HWY_INLINE Eight pick(Eight low, Eight high, Eight places) {
  const Eight seven = hn::Set(kEight, 7);
  const Eight place = hn::And(places, seven);
  return hn::IfThenElse(hn::Gt(places, seven), pick(high, place), pick(low, place));
}

#else

using Eight = std::array<std::uint32_t, 8>;

template <class Number>
HWY_INLINE Eight load(const Number* from) {
  Eight v;
  std::copy(from, from + 8, v.begin());
  return v;
}
HWY_INLINE Eight add(const Eight& a, const Eight& b) {
  Eight sum;
  for (int i = 0; i < 8; ++i) sum[i] = a[i] + b[i];
  return sum;
}
HWY_INLINE void store(const Eight& v, std::uint32_t* to) { std::copy(v.begin(), v.end(), to); }
HWY_INLINE Eight pick(const Eight& from, const Eight& places) {
  Eight picked;
  for (int i = 0; i < 8; ++i) picked[i] = from[places[i]];
  return picked;
}
HWY_INLINE Eight pick(const Eight& low, const Eight& high, const Eight& places) {
  Eight picked;
  for (int i = 0; i < 8; ++i) picked[i] = places[i] < 8 ? low[places[i]] : high[places[i] - 8];
  return picked;
}

#endif

/// The numbers that run along a row of cells: the next vertex on each of the rows of grid edges around it, and the next
/// half-edge on each of its rows of faces and inside.
class RowCounters {
 public:
  HWY_INLINE RowCounters(const MarchState& march, int j, int k) {
    const Counts& lower = march.slabs[k].first;
    const Counts& upper = march.slabs[k + 1].first;
    const Counts* rows = march.slab_rows(k) + j;
    const Counts* upper_rows = march.slab_rows(k + 1) + j;
    const std::uint32_t y[2] = {lower.vertex_y + rows[0].vertex_y, upper.vertex_y + upper_rows[0].vertex_y};
    const std::uint32_t z[2] = {lower.vertex_z + rows[0].vertex_z, lower.vertex_z + rows[1].vertex_z};
    const std::array<std::uint32_t, 16> vertex = {lower.vertex_x + rows[0].vertex_x,
                                                  lower.vertex_x + rows[1].vertex_x,
                                                  upper.vertex_x + upper_rows[0].vertex_x,
                                                  upper.vertex_x + upper_rows[1].vertex_x,
                                                  y[0],
                                                  y[0],
                                                  y[1],
                                                  y[1],
                                                  z[0],
                                                  z[0],
                                                  z[1],
                                                  z[1]};
    low_ = load(vertex.data());
    high_ = load(vertex.data() + 8);
    const std::uint32_t face_x = 2 * (lower.face_x + rows[0].face_x);
    const std::array<std::uint32_t, 8> half = {face_x,
                                               face_x,
                                               2 * (lower.face_y + rows[0].face_y),
                                               2 * (lower.face_y + rows[1].face_y),
                                               2 * (lower.face_z + rows[0].face_z),
                                               2 * (upper.face_z + upper_rows[0].face_z),
                                               2 * (lower.inner + rows[0].inner)};
    half_ = load(half.data());
  }

  /// The vertices of the cell's sixteen triangle corners (see CellCase), and on to the next cell.
  HWY_INLINE void pass_vertices(const CellCase& cell, std::uint32_t* corners) {
    const Eight low = add(low_, load(cell.offset.data()));
    const Eight high = add(high_, load(cell.offset.data() + 8));
    store(pick(low, high, load(cell.vertex.data())), corners);
    store(pick(low, high, load(cell.vertex.data() + 8)), corners + 8);
    low_ = add(low_, load(cell.step.data()));
    high_ = add(high_, load(cell.step.data() + 8));
  }
  /// The half-edges that leave these corners, and on to the next cell.
  HWY_INLINE void pass_half_edges(const CellCase& cell, std::uint32_t* leaving) {
    const Eight first = add(half_, load(cell.half_offset.data()));
    for (int c = 0; c < 16; c += 8)
      store(add(pick(first, load(cell.slot.data() + c)), load(cell.half.data() + c)), leaving + c);
    half_ = add(half_, load(cell.half_step.data()));
  }

 private:
  Eight low_;   ///< for each of the cube's edges 0 to 7 the next vertex on its row
  Eight high_;  ///< of its edges 8 to 11
  Eight half_;  ///< the next half-edge on each face's row, and inside
};

/// Calls visit(cell case, counters) for every mixed cell of slab k; visit moves the counters on.
template <class Visit>
HWY_INLINE void for_each_cell(const MarchState& march, int k, const CaseTable& cases, const Visit& visit) {
  const CellList& list = march.slabs[k].cells;
  const std::uint8_t* inside = list.cases.data();
  for (const CellList::Row& row : list.rows) {
    RowCounters counters(march, row.row, k);
    for (const std::uint8_t* end = inside + row.cells; inside < end; ++inside) visit(cases[*inside], counters);
  }
}

void make_triangles_wide(const MarchState& march, int k, const CaseTable& cases, Triangle* triangles) {
  const Slab& slab = march.slabs[k];
  if (slab.total.triangle == 0) return;
  constexpr int kCorners = 16;
  std::uint32_t* out = (triangles + slab.first.triangle)->data();
  // All corners of a case are written, the next cell's over those it does not have. Where the last ones would reach
  // beyond the slab, which another thread may have written, they go by here.
  std::uint32_t* const end = out + std::size_t(3) * slab.total.triangle;
  for_each_cell(march, k, cases, [&](const CellCase& cell, RowCounters& counters) HWY_ATTR {
    const std::size_t count = std::size_t(3) * cell.triangles;
    if (end - out >= kCorners) {
      counters.pass_vertices(cell, out);
    } else {
      std::uint32_t corners[kCorners];
      counters.pass_vertices(cell, corners);
      std::copy(corners, corners + count, out);
    }
    out += count;
  });
}

HWY_INLINE void write_triangle(const std::uint32_t* vertex, const std::uint32_t* leaving, std::uint32_t face,
                               HalfEdgeRecord* half_edges) {
  const auto v = [&](int i) { return std::int32_t(vertex[i]); };
  const auto h = [&](int i) { return std::int32_t(leaving[i]); };
  const auto f = std::int32_t(face);
  half_edges[leaving[0]] = {.face = f, .to_vertex = v(1), .next = h(1), .previous = h(2)};
  half_edges[leaving[1]] = {.face = f, .to_vertex = v(2), .next = h(2), .previous = h(0)};
  half_edges[leaving[2]] = {.face = f, .to_vertex = v(0), .next = h(0), .previous = h(1)};
}

void make_half_edges_wide(const MarchState& march, int k, const CaseTable& cases, const HalfEdgeArrays& out) {
  std::uint32_t face = march.slabs[k].first.triangle;
  for_each_cell(march, k, cases, [&](const CellCase& cell, RowCounters& counters) HWY_ATTR {
    std::uint32_t vertex[16];
    std::uint32_t leaving[16];
    counters.pass_vertices(cell, vertex);
    counters.pass_half_edges(cell, leaving);
    for (unsigned t = 0; t < cell.triangles; ++t, ++face) {
      write_triangle(vertex + 3 * t, leaving + 3 * t, face, out.half_edges);
      out.face_half_edge[face] = std::int32_t(leaving[3 * t]);
    }
    for (const std::int8_t corner : cell.owned)
      if (corner >= 0) out.vertex_half_edge[vertex[corner]] = std::int32_t(leaving[corner]);
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
