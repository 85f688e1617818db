#include <algorithm>
#include <bit>

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

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3  // wider targets have lower numbers

/// Writes the cases of one word's mixed cells, and up to 64 bytes. Gives how many there are.
std::uint32_t list_cells(const WordBits& bits, std::uint64_t mixed, std::uint8_t* list) {
  // Each corner's bits of the mixed cells, drawn together, are a mask of bytes: no cell is looked at by itself.
  const hn::FixedTag<std::uint8_t, 64> d;
  auto inside = hn::Zero(d);
  const auto add = [&](std::uint64_t row, int corner) HWY_ATTR {
    const std::uint64_t drawn = _pext_u64(row, mixed);
    const auto mask = hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&drawn));
    inside = hn::Or(inside, hn::IfThenElseZero(mask, hn::Set(d, std::uint8_t(1 << corner))));
  };
  for (int r = 0; r < 4; ++r) {
    add(bits.here[r], 2 * r);
    add(bits.next[r], 2 * r + 1);
  }
  hn::StoreU(inside, d, list);
  return ones(mixed);
}

#else

std::uint32_t list_cells(const WordBits& bits, std::uint64_t mixed, std::uint8_t* list) {
  const std::uint32_t count = ones(mixed);
  for (std::uint32_t n = 0; n < count; ++n, mixed &= mixed - 1)
    list[n] = std::uint8_t(bits.corners(std::countr_zero(mixed)));
  return count;
}

#endif

/// What the listed cells hold: triangles, and inner edges.
void count_cells(const CaseTable& cases, const std::uint8_t* list, std::uint32_t count, Counts& counts) {
  // Two sums at once, as each waits for the one before.
  std::uint64_t held[2] = {0, 0};
  std::uint32_t n = 0;
  for (; n + 2 <= count; n += 2) {
    held[0] += cases.counts(list[n]);
    held[1] += cases.counts(list[n + 1]);
  }
  if (n < count) held[0] += cases.counts(list[n]);
  const std::uint64_t sum = held[0] + held[1];
  counts.triangle += std::uint32_t(sum & 0xffffffff);
  counts.inner += std::uint32_t(sum >> 32);
}

/// The bits of a vector of words.
struct VectorBits {
  static constexpr int kMost = HWY_MAX_BYTES / 8;
  alignas(HWY_MAX_BYTES) std::uint64_t here[4][kMost];
  alignas(HWY_MAX_BYTES) std::uint64_t next[4][kMost];

  [[nodiscard]] HWY_INLINE WordBits word(int lane) const {
    WordBits bits;
    for (int r = 0; r < 4; ++r) {
      bits.here[r] = here[r][lane];
      bits.next[r] = next[r][lane];
    }
    return bits;
  }
};

/// Calls visit(row, word, bits) for the words of slab k that may hold anything: most hold nothing, and vectors tell
/// that of several at once. Rows lie one after the other, so vectors go on over their ends.
template <class Visit>
HWY_INLINE void visit_slab(const MarchState& march, int k, const Visit& visit) {
  const hn::ScalableTag<std::uint64_t> d;
  const std::ptrdiff_t lanes = std::ptrdiff_t(hn::Lanes(d));
  const std::ptrdiff_t row = march.words;
  const std::ptrdiff_t plane = row * march.ny;
  // On the last row and plane, upper neighbours are not where they are elsewhere.
  const std::ptrdiff_t end = k + 1 < march.nz ? plane - row : 0;
  const std::uint64_t* first = march.row_bits(0, k);
  const std::uint64_t* rows[4] = {first, first + row, first + plane, first + plane + row};
  int j = 0;
  std::ptrdiff_t at = 0;
  std::ptrdiff_t row_begin = 0;
  const auto word_at = [&](std::ptrdiff_t place) HWY_ATTR {
    for (; place >= row_begin + row; row_begin += row) ++j;
    return int(place - row_begin);
  };
  for (; at + lanes <= end; at += lanes) {
    VectorBits bits;
    auto any = hn::Zero(d);
    auto all = hn::Set(d, ~std::uint64_t(0));
    for (int r = 0; r < 4; ++r) {
      const auto here = hn::LoadU(d, rows[r] + at);
      // After a row's last word comes the next row's: it says too much at most of a grid point that has no cell.
      const auto next = hn::Or(hn::ShiftRight<1>(here), hn::ShiftLeft<63>(hn::LoadU(d, rows[r] + at + 1)));
      any = hn::Or(any, hn::Or(here, next));
      all = hn::And(all, hn::And(here, next));
      hn::Store(here, d, bits.here[r]);
      hn::Store(next, d, bits.next[r]);
    }
    const auto mixed = hn::Ne(hn::AndNot(all, any), hn::Zero(d));
    if (hn::AllFalse(d, mixed)) continue;
    alignas(8) std::uint8_t lane_bits[8] = {};
    hn::StoreMaskBits(d, mixed, lane_bits);
    for (unsigned left = lane_bits[0]; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      const int word = word_at(at + lane);
      visit(j, word, bits.word(lane));
    }
  }
  for (; at < plane; ++at) {
    const int word = word_at(at);
    visit(j, word, WordBits(march, j, k, word));
  }
}

template <Connectivity kConnectivity>
void count_slab_wide(MarchState& march, int k, const std::uint32_t* candidates, std::size_t candidate_count) {
  const CaseTable& cases = case_table(CaseTable::Winding::kOutwards);  // counts are the same for both
  Counts counts{};
  std::uint32_t* active = march.slab_active(k);
  Counts* rows = march.slab_rows(k);
  CellList& list = march.slabs[k].cells;
  list.rows.clear();
  std::uint32_t found = 0;
  std::uint32_t cells = 0;
  std::uint32_t counted = 0;
  int last_row = -1;
  const auto visit = [&](int j, int word, const WordBits& bits) HWY_ATTR {
    const auto& [a, b, c, d] = bits.here;
    const std::uint64_t mixed = bits.mixed(march.cell_mask(word));
    const std::uint64_t differing = ((a | b | c | d) & ~(a & b & c & d)) | mixed;
    if (differing == 0) return;
    if (j != last_row) {
      count_cells(cases, list.cases.data() + counted, cells - counted, counts);
      counted = cells;
      rows[j] = counts;
      last_row = j;
    }
    active[found++] = pack_word(j, word);
    count_word<kConnectivity>(march, j, k, word, bits, counts);
    if (mixed == 0 || j + 1 >= march.ny || k + 1 >= march.nz) return;
    if (list.rows.empty() || list.rows.back().row != j) list.rows.push_back({.row = j, .cells = 0});
    const std::uint32_t count = list_cells(bits, mixed, list.room(cells, 64));
    list.rows.back().cells += count;
    cells += count;
  };
  if (candidates != nullptr) {
    for (std::size_t n = 0; n < candidate_count; ++n) {
      const int j = row_of(candidates[n]);
      const int word = word_of(candidates[n]);
      visit(j, word, WordBits(march, j, k, word));
    }
  } else {
    visit_slab(march, k, visit);
  }
  count_cells(cases, list.cases.data() + counted, cells - counted, counts);
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

HWY_EXPORT(count_slab_indexed);
HWY_EXPORT(count_slab_half_edges);

void count_slab(MarchState& march, int k, const std::uint32_t* candidates, std::size_t candidate_count,
                Connectivity connectivity) {
  if (connectivity == Connectivity::kIndexed)
    HWY_DYNAMIC_DISPATCH(count_slab_indexed)(march, k, candidates, candidate_count);
  else
    HWY_DYNAMIC_DISPATCH(count_slab_half_edges)(march, k, candidates, candidate_count);
}

}  // namespace isolux::mc
#endif
