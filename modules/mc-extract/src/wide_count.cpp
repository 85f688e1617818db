#include <algorithm>
#include <bit>
#include <limits>

#include "wide_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide_count.cpp"
#include <hwy/foreach_target.h>
// After it, as Highway wants.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace isolux::mc {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;

/// The inside bits of one vector of values.
template <class Vector>
std::uint64_t inside_bits(const Floats d, const Vector value, const Vector isovalue, OuterSide outer) {
  const auto inside = outer == OuterSide::kLower ? hn::Ge(value, isovalue) : hn::Le(value, isovalue);
  alignas(8) std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, inside, bytes);
  if (hn::Lanes(d) <= 8) return bytes[0];
  std::uint64_t bits = 0;
  for (std::size_t b = 0; b < hn::Lanes(d) / 8; ++b) bits |= std::uint64_t(bytes[b]) << (8 * b);
  return bits;
}

/// The inside bits of up to 64 values.
std::uint64_t classify_word(const MarchState& march, const float* values, int count) {
  const Floats d;
  const int lanes = int(hn::Lanes(d));
  const auto isovalue = hn::Set(d, march.isovalue);
  std::uint64_t word = 0;
  int i = 0;
  for (; i + lanes <= count; i += lanes) word |= inside_bits(d, hn::LoadU(d, values + i), isovalue, march.outer) << i;
  for (; i < count; ++i) {
    const bool inside = march.outer == OuterSide::kLower ? values[i] >= march.isovalue : values[i] <= march.isovalue;
    word |= std::uint64_t(inside) << i;
  }
  return word;
}

void classify_row_wide(MarchState& march, int j, int k) {
  const float* values = march.row_values(j, k);
  std::uint64_t* bits = march.row_bits(j, k);
  for (int word = 0; word < march.words; ++word)
    bits[word] = classify_word(march, values + 64 * word, std::min(64, march.nx - 64 * word));
}

void classify_bricks_wide(MarchState& march, const BrickRows& rows, int word, unsigned active, std::uint64_t uniform) {
  const int count = std::min(64, march.nx - 64 * word);
  for (int k = rows.first_plane; k < rows.last_plane; ++k) {
    for (int j = rows.first_row; j < rows.last_row; ++j) {
      const float* values = march.row_values(j, k) + 64 * word;
      std::uint64_t bits = uniform;
      for (unsigned left = active; left != 0; left &= left - 1) {
        const int first = 16 * std::countr_zero(left);
        bits |= classify_word(march, values + first, std::min(16, count - first)) << first;
      }
      march.row_bits(j, k)[word] = bits;
    }
  }
}

void find_range_wide(const Volume& volume, const Index3& first, const Index3& last, float& low, float& high) {
  const Floats d;
  const int lanes = int(hn::Lanes(d));
  const Lattice& lattice = volume.lattice();
  const float* values = volume.values.values().data();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  auto lowest = hn::Set(d, kInfinity);
  auto highest = hn::Set(d, -kInfinity);
  auto odd = hn::MaskFromVec(hn::Zero(d));
  low = kInfinity;
  high = -kInfinity;
  const int count = last.x - first.x + 1;
  bool odd_tail = false;
  for (int k = first.z; k <= last.z; ++k) {
    for (int j = first.y; j <= last.y; ++j) {
      const float* row = values + lattice.offset(first.x, j, k);
      int i = 0;
      for (; i + lanes <= count; i += lanes) {
        const auto value = hn::LoadU(d, row + i);
        lowest = hn::Min(lowest, value);
        highest = hn::Max(highest, value);
        odd = hn::Or(odd, hn::Ne(value, value));
      }
      for (; i < count; ++i) {
        low = std::min(low, row[i]);
        high = std::max(high, row[i]);
        odd_tail |= row[i] != row[i];  // NOLINT(misc-redundant-expression): true of NaN alone
      }
    }
  }
  low = std::min(low, hn::GetLane(hn::MinOfLanes(d, lowest)));
  high = std::max(high, hn::GetLane(hn::MaxOfLanes(d, highest)));
  if (odd_tail || !hn::AllFalse(d, odd)) {
    low = -kInfinity;
    high = kInfinity;
  }
}

std::uint32_t ones(std::uint64_t bits) { return std::uint32_t(std::popcount(bits)); }

/// Segments on 64 faces with the corners a b / c d: one where the corners differ, two where they alternate.
std::uint32_t segments(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d, std::uint64_t mask) {
  const std::uint64_t some = (a | b | c | d) & ~(a & b & c & d) & mask;
  const std::uint64_t alternating = (a ^ b) & (c ^ d) & (a ^ c) & mask;
  return ones(some) + ones(alternating);
}

/// Adds what the grid points of one word own, but for what its cells hold.
template <Connectivity kConnectivity>
void count_word(const MarchState& march, int j, int k, int word, const WordBits& bits, Counts& counts) {
  const auto& [a, b, c, d] = bits.here;
  const std::uint64_t cells = march.cell_mask(word);
  counts.vertex_x += ones((a ^ bits.next[0]) & cells);
  counts.vertex_y += ones(a ^ b);
  counts.vertex_z += ones(a ^ c);
  if constexpr (kConnectivity == Connectivity::kHalfEdges) {
    const bool below_last_row = j + 1 < march.ny;
    const bool below_last_plane = k + 1 < march.nz;
    if (below_last_row && below_last_plane) counts.face_x += segments(a, b, c, d, ~std::uint64_t(0));
    if (below_last_plane) counts.face_y += segments(a, bits.next[0], c, bits.next[2], cells);
    if (below_last_row) counts.face_z += segments(a, bits.next[0], b, bits.next[1], cells);
  }
}

/// Lists the mixed cells of one word and adds what they hold.
std::uint32_t list_cells(const WordBits& bits, std::uint64_t mixed, const CaseTable& cases, std::uint8_t* list,
                         Counts& counts) {
  const std::uint32_t count = ones(mixed);
  std::uint32_t held = 0;
  for (std::uint32_t n = 0; n < count; ++n, mixed &= mixed - 1) {
    const unsigned inside = bits.corners(std::countr_zero(mixed));
    list[n] = std::uint8_t(inside);
    held += cases.counts(inside);
  }
  counts.triangle += held & 0xffff;
  counts.inner += held >> 16;
  return count;
}

/// Visits the words of a row that may hold anything: nearly all hold nothing, and vectors tell that of several at once.
template <class Visit>
void visit_row(const MarchState& march, int j, int k, const Visit& visit) {
  const hn::ScalableTag<std::uint64_t> d;
  const int lanes = int(hn::Lanes(d));
  const int upper_row = std::min(j + 1, march.ny - 1);
  const int upper_plane = std::min(k + 1, march.nz - 1);
  const std::uint64_t* rows[4] = {march.row_bits(j, k), march.row_bits(upper_row, k), march.row_bits(j, upper_plane),
                                  march.row_bits(upper_row, upper_plane)};
  int word = 0;
  for (; word + lanes <= march.words; word += lanes) {
    const auto load = [&](int row, int offset) HWY_ATTR { return hn::LoadU(d, rows[row] + word + offset); };
    const auto any = [&](int offset) HWY_ATTR {
      return hn::Or(hn::Or(load(0, offset), load(1, offset)), hn::Or(load(2, offset), load(3, offset)));
    };
    const auto all = [&](int offset) HWY_ATTR {
      return hn::And(hn::And(load(0, offset), load(1, offset)), hn::And(load(2, offset), load(3, offset)));
    };
    // After a row's last word comes the next row's: it says too much at most of a grid point that has no cell.
    const auto next = [&](auto here, auto after)
                          HWY_ATTR { return hn::Or(hn::ShiftRight<1>(here), hn::ShiftLeft<63>(after)); };
    const auto any_here = any(0);
    const auto all_here = all(0);
    const auto differing =
        hn::AndNot(hn::And(all_here, next(all_here, all(1))), hn::Or(any_here, next(any_here, any(1))));
    const auto uniform = hn::Eq(differing, hn::Zero(d));
    if (hn::AllTrue(d, uniform)) continue;
    for (int n = 0; n < lanes; ++n) visit(j, word + n);
  }
  for (; word < march.words; ++word) visit(j, word);
}

template <Connectivity kConnectivity>
void count_slab_wide(MarchState& march, int k, const std::uint32_t* candidates, std::size_t candidate_count) {
  const CaseTable& cases = case_table(CaseTable::Winding::kOutwards);  // counts are the same for both
  Counts counts;
  std::uint32_t* active = march.slab_active(k);
  Counts* rows = march.slab_rows(k);
  CellList& list = march.slabs[k].cells;
  list.rows.clear();
  std::uint32_t found = 0;
  std::uint32_t cells = 0;
  int last_row = -1;
  const auto visit = [&](int j, int word) HWY_ATTR {
    const WordBits bits(march, j, k, word);
    const auto& [a, b, c, d] = bits.here;
    const std::uint64_t mixed = bits.mixed(march.cell_mask(word));
    const std::uint64_t differing = ((a | b | c | d) & ~(a & b & c & d)) | mixed;
    if (differing == 0) return;
    if (j != last_row) rows[j] = counts;
    last_row = j;
    active[found++] = pack_word(j, word);
    count_word<kConnectivity>(march, j, k, word, bits, counts);
    if (mixed == 0 || j + 1 >= march.ny || k + 1 >= march.nz) return;
    if (list.rows.empty() || list.rows.back().row != j) list.rows.push_back({.row = j, .cells = 0});
    const std::uint32_t count = list_cells(bits, mixed, cases, list.room(cells, 64), counts);
    list.rows.back().cells += count;
    cells += count;
  };
  if (candidates != nullptr) {
    for (std::size_t n = 0; n < candidate_count; ++n) visit(row_of(candidates[n]), word_of(candidates[n]));
  } else {
    for (int j = 0; j < march.ny; ++j) visit_row(march, j, k, visit);
  }
  march.slabs[k].active_words = found;
  march.slabs[k].total = counts;
}

void count_slab_indexed(MarchState& march, int k, const std::uint32_t* candidates, std::size_t candidate_count) {
  count_slab_wide<Connectivity::kIndexed>(march, k, candidates, candidate_count);
}

void count_slab_half_edges(MarchState& march, int k, const std::uint32_t* candidates, std::size_t candidate_count) {
  count_slab_wide<Connectivity::kHalfEdges>(march, k, candidates, candidate_count);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace isolux::mc
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::mc {

HWY_EXPORT(classify_row_wide);
HWY_EXPORT(classify_bricks_wide);
HWY_EXPORT(find_range_wide);
HWY_EXPORT(count_slab_indexed);
HWY_EXPORT(count_slab_half_edges);

void classify_row(MarchState& march, int j, int k) { HWY_DYNAMIC_DISPATCH(classify_row_wide)(march, j, k); }

void classify_bricks(MarchState& march, const BrickRows& rows, int word, unsigned active, std::uint64_t uniform) {
  HWY_DYNAMIC_DISPATCH(classify_bricks_wide)(march, rows, word, active, uniform);
}

void find_range(const Volume& volume, const Index3& first, const Index3& last, float& low, float& high) {
  HWY_DYNAMIC_DISPATCH(find_range_wide)(volume, first, last, low, high);
}

void count_slab(MarchState& march, int k, const std::uint32_t* candidates, std::size_t candidate_count,
                Connectivity connectivity) {
  if (connectivity == Connectivity::kIndexed)
    HWY_DYNAMIC_DISPATCH(count_slab_indexed)(march, k, candidates, candidate_count);
  else
    HWY_DYNAMIC_DISPATCH(count_slab_half_edges)(march, k, candidates, candidate_count);
}

}  // namespace isolux::mc
#endif
