#pragma once

#include <array>
#include <cstdint>

namespace isolux::mc {

/// How many of a row's or cell's counters a case uses up, in bytes, as 40 kB of wider numbers would not stay in the
/// nearest cache; see CaseTable.
struct alignas(64) CellCase {
  /// Vertex numbers run along the four rows of x edges and the two rows each of y and z edges: what is added to a row's
  /// next number for each edge's vertex, and once the cell is done. By cube edge; four more are 0.
  std::array<std::uint8_t, 16> offset{};
  std::array<std::uint8_t, 16> step{};
  std::array<std::uint8_t, 16> vertex{};  ///< cube edge of each triangle corner; beyond the last, the first triangle's
  std::uint8_t triangles = 0;
  std::uint8_t inner_edges = 0;
  std::array<std::int8_t, 3> owned{-1, -1, -1};  ///< a half-edge leaving the vertex on edge 0, 4, 8, or -1
  std::array<std::uint8_t, 16> slot{};           ///< of each half-edge: the face it lies on, 6 for inside the cell
  std::array<std::uint8_t, 16> half{};           ///< its number among the half-edges of that face or of the inside
  /// As offset and step, for half-edges on the six faces and, seventh, inside; both faces across x are on one row.
  std::array<std::uint8_t, 8> half_offset{};
  std::array<std::uint8_t, 8> half_step{};
};

/// The 256 cases of marching cubes, made by rule so that any two neighbours fit: inside corners are kept apart on every
/// ambiguous face, seen alike from both sides; no diagonal lies in a face; one vertex a crossed edge. At most five
/// triangles. Half-edge 3 t + i of a cell runs from corner i of triangle t to the next corner. An edge on a face shared
/// by two cells has its half-edge 0 in the lower cell and 1 in the upper one.
class CaseTable {
 public:
  enum class Winding : std::uint8_t {
    kOutwards,  ///< counter-clockwise seen from the side that is not inside
    kInwards    ///< for frames that mirror
  };
  explicit CaseTable(Winding winding);
  [[nodiscard]] const CellCase& operator[](unsigned inside) const { return cases_[inside]; }
  /// The triangles of a case, and 2^32 times its inner edges: both summed at once.
  [[nodiscard]] std::uint64_t counts(unsigned inside) const { return counts_[inside]; }

 private:
  std::array<CellCase, 256> cases_;
  std::array<std::uint64_t, 256> counts_{};
};

/// The table of each winding, made once.
[[nodiscard]] const CaseTable& case_table(CaseTable::Winding winding);

}  // namespace isolux::mc
