#pragma once

#include <isolux/core/volume.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "level_set.h"

/// What the passes of the row-wise marching cubes share. One bit a voxel says whether it is inside; 64 voxels of a row
/// are a *word*. A grid point owns the three edges that leave it upwards, the three faces that have it as their lowest
/// corner and the cell above it, so a *slab* k is all that the grid points of plane k own. Numbers of vertices,
/// triangles and edges run along rows: a cell finds those it needs by counters that run along the four rows around it,
/// with no search. After Schroeder, Maynard & Geveci, "Flying edges" (LDAV 2015), with bits in place of their edge
/// cases.
namespace isolux::mc {

/// A word of a slab as one number, rising along rows: at most 1024 words a row.
inline constexpr int kWordBits = 10;
constexpr std::uint32_t pack_word(int row, int word) { return std::uint32_t(row) << kWordBits | std::uint32_t(word); }
constexpr int row_of(std::uint32_t packed) { return int(packed >> kWordBits); }
constexpr int word_of(std::uint32_t packed) { return int(packed & ((1U << kWordBits) - 1)); }

/// For each kind of thing its number: within a slab (of a row's first) or in the mesh (of a slab's first).
struct Counts {
  std::uint32_t vertex_x;  ///< vertices on edges along x, y, z
  std::uint32_t vertex_y;
  std::uint32_t vertex_z;
  std::uint32_t face_x;  ///< mesh edges on faces across x, y, z
  std::uint32_t face_y;
  std::uint32_t face_z;
  std::uint32_t inner;  ///< mesh edges inside cells
  std::uint32_t triangle;
};

/// The mixed cells of a slab along its rows: what connecting them needs, so that bits are looked at once only.
struct CellList {
  struct Row {
    int row;
    std::uint32_t cells;
  };
  std::vector<Row> rows;            ///< those with a mixed cell
  std::vector<std::uint8_t> cases;  ///< corners inside, of cell after cell; longer than needed

  /// Where `count` cases may be written after `used` ones.
  [[nodiscard]] std::uint8_t* room(std::size_t used, std::size_t count) {
    if (cases.size() < used + count) cases.resize(2 * used + 16 * count);
    return cases.data() + used;
  }
};

/// One slab's part of the work: how many words of it hold anything, how many things, and their first numbers.
struct Slab {
  std::uint32_t active_words = 0;
  CellList cells;
  Counts total{};
  Counts first{};
};

/// How much there is of each kind in the mesh.
struct MeshSize {
  std::size_t vertices = 0;
  std::size_t edges = 0;
  std::size_t triangles = 0;
};

enum class Connectivity : std::uint8_t {
  kIndexed,   ///< triangles of vertex numbers
  kHalfEdges  ///< numbers for mesh edges too
};

/// Views of the grid and of the extractor's buffers.
struct MarchState {
  VolumeView::Voxels voxels;
  int nx = 0;
  int ny = 0;
  int nz = 0;
  int words = 0;  ///< a row

  float isovalue = 0.0f;
  OuterSide outer = OuterSide::kLower;

  std::uint64_t* bits = nullptr;    ///< [nz][ny][words], and one word more
  Counts* rows = nullptr;           ///< [nz][ny], of rows with an active word: numbers within the slab
  std::uint32_t* active = nullptr;  ///< [nz][ny * words]: a slab's words that hold anything, packed, rising
  Slab* slabs = nullptr;            ///< [nz]

  [[nodiscard]] const std::uint64_t* row_bits(int j, int k) const {
    return bits + (std::size_t(k) * std::size_t(ny) + std::size_t(j)) * std::size_t(words);
  }
  [[nodiscard]] std::uint64_t* row_bits(int j, int k) {
    return bits + (std::size_t(k) * std::size_t(ny) + std::size_t(j)) * std::size_t(words);
  }
  /// Value: the type of the voxels.
  template <class Value>
  [[nodiscard]] const Value* row_values(int j, int k) const {
    return all_values<Value>().data() + (std::size_t(k) * std::size_t(ny) + std::size_t(j)) * std::size_t(nx);
  }
  template <class Value>
  [[nodiscard]] std::span<const Value> all_values() const {
    return *std::get_if<std::span<const Value>>(&voxels);
  }
  [[nodiscard]] std::uint32_t* slab_active(int k) const { return active + std::size_t(k) * std::size_t(ny * words); }
  [[nodiscard]] Counts* slab_rows(int k) const { return rows + std::size_t(k) * std::size_t(ny); }
  /// Bit i is set where grid point 64 word + i has a cell above it along x.
  [[nodiscard]] std::uint64_t cell_mask(int word) const {
    const int cells = nx - 1 - 64 * word;
    return cells >= 64 ? ~std::uint64_t(0) : cells <= 0 ? 0 : (std::uint64_t(1) << cells) - 1;
  }
  /// The word moved by one voxel: bit i is the inside bit of grid point 64 word + i + 1.
  [[nodiscard]] std::uint64_t next_bits(const std::uint64_t* row, int word) const {
    return row[word] >> 1 | (word + 1 < words ? row[word + 1] << 63 : 0);
  }
};

/// The bits of 64 cells' corners: in `here[y + 2 z]` of the corners at their low x, in `next` at their high x. Rows
/// beyond the grid repeat the last one, so that nothing is crossed towards them.
struct WordBits {
  std::array<std::uint64_t, 4> here;
  std::array<std::uint64_t, 4> next;

  WordBits() = default;
  WordBits(const MarchState& march, int j, int k, int word) {
    for (int r = 0; r < 4; ++r) {
      const int row = (r & 1) != 0 && j + 1 < march.ny ? j + 1 : j;
      const int plane = r >= 2 && k + 1 < march.nz ? k + 1 : k;
      const std::uint64_t* bits = march.row_bits(row, plane);
      here[r] = bits[word];
      next[r] = march.next_bits(bits, word);
    }
  }
  /// Cells of `mask` that are neither all inside nor all outside.
  [[nodiscard]] std::uint64_t mixed(std::uint64_t mask) const {
    const std::uint64_t any = here[0] | here[1] | here[2] | here[3] | next[0] | next[1] | next[2] | next[3];
    const std::uint64_t all = here[0] & here[1] & here[2] & here[3] & next[0] & next[1] & next[2] & next[3];
    return any & ~all & mask;
  }
  /// The case of cell i: bit c for corner c.
  [[nodiscard]] unsigned corners(int i) const {
    // Both ends of a row's edge are neighbouring bits of one word, but for the last.
    if (i < 63)
      return unsigned(here[0] >> i & 3) | unsigned(here[1] >> i & 3) << 2 | unsigned(here[2] >> i & 3) << 4 |
             unsigned(here[3] >> i & 3) << 6;
    unsigned inside = 0;
    for (int r = 0; r < 4; ++r)
      inside |= unsigned(here[r] >> i & 1) << (2 * r) | unsigned(next[r] >> i & 1) << (2 * r + 1);
    return inside;
  }
};

}  // namespace isolux::mc
