#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid_index.h"

namespace isolux {

/// The cells of one size of a TexelPyramid that there are, by eights: those that a cell of the level above fell apart
/// into lie together, in the order in which they came to be. On the highest level there are all, by number.
struct CellLevel {
  struct Figures {
    float roughness = 0.0f;
    float noise = 0.0f;
  };
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  Index3 size{0};                      ///< cells, whether there are or not
  Index3 size_above{0};                ///< 0 on the highest level
  std::vector<std::uint32_t> first{};  ///< of a cell of the level above: where its eight begin, or kNone
  std::vector<std::uint32_t> above{};  ///< of eight: the number of the cell that fell apart
  std::vector<std::uint8_t> leaf{};    ///< of a cell that there is: it has not fallen apart
  std::vector<Figures> raw{};          ///< of a cell's own corners; negative noise: none is lit
  std::vector<Figures> figures{};      ///< with its neighbours

  static std::uint32_t number(const Index3& size, const Index3& i) {
    return (std::uint32_t(i.z) * std::uint32_t(size.y) + std::uint32_t(i.y)) * std::uint32_t(size.x) +
           std::uint32_t(i.x);
  }
  [[nodiscard]] std::uint32_t number(const Index3& i) const { return number(size, i); }
  [[nodiscard]] std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }

  /// Where a cell is kept; kNone if there is none.
  [[nodiscard]] std::uint32_t place(const Index3& i) const {
    if (!inside(i, size)) return kNone;
    if (size_above.x == 0) return number(i);
    const std::uint32_t begin = first[number(size_above, i / 2)];
    return begin == kNone ? kNone : begin + child(i);
  }
  [[nodiscard]] Index3 at(std::size_t place) const {
    if (size_above.x == 0) return index_of(size, place);
    return index_of(size_above, above[place / 8]) * 2 + corner_step(int(place % 8));
  }
  /// Makes the eight below a cell of the level above. Some may lie outside: they are no leaves.
  void add_below(std::uint32_t number_above) {
    first[number_above] = std::uint32_t(leaf.size());
    above.push_back(number_above);
    leaf.resize(leaf.size() + 8, 0);
  }
  /// The places of a cell and those around it, x fastest; kNone.
  [[nodiscard]] std::array<std::uint32_t, 27> places_around(const Index3& i) const;

 private:
  static std::uint32_t child(const Index3& i) { return std::uint32_t((i.x & 1) | (i.y & 1) << 1 | (i.z & 1) << 2); }
};

inline std::array<std::uint32_t, 27> CellLevel::places_around(const Index3& i) const {
  std::array<std::uint32_t, 27> places{};
  std::array<std::uint32_t, 8> begins{};
  const Index3 low((i.x - 1) >> 1, (i.y - 1) >> 1, (i.z - 1) >> 1);
  if (size_above.x != 0) {
    // Three cells in a row always lie below two of the level above.
    for (int c = 0; c < 8; ++c) {
      const Index3 a = low + corner_step(c);
      begins[std::size_t(c)] = inside(a, size_above) ? first[number(size_above, a)] : kNone;
    }
  }
  for (int q = 0; q < 27; ++q) {
    const Index3 near = i + Index3(q % 3 - 1, q / 3 % 3 - 1, q / 9 - 1);
    if (size_above.x == 0) {
      places[std::size_t(q)] = place(near);
      continue;
    }
    const Index3 s((near.x >> 1) - low.x, (near.y >> 1) - low.y, (near.z >> 1) - low.z);
    const std::uint32_t begin = begins[std::size_t(s.x | s.y << 1 | s.z << 2)];
    places[std::size_t(q)] = begin == kNone ? kNone : begin + child(near);
  }
  return places;
}

}  // namespace isolux
