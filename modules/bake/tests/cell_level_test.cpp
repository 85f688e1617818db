// Cells kept by eights where they came to be: each is found again at its place, and those around it too.
#include "cell_level.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace isolux::test {
namespace {

/// Below four cells of 3 x 2 x 2 there are eight each, some of them outside the 5 x 4 x 3.
CellLevel some_cells() {
  CellLevel level;
  level.size = Index3(5, 4, 3);
  level.size_above = Index3(3, 2, 2);
  level.first.assign(12, CellLevel::kNone);
  for (const std::uint32_t above : {11u, 0u, 6u, 3u}) level.add_below(above);
  return level;
}

CellLevel highest_level() {
  CellLevel level;
  level.size = Index3(5, 4, 3);
  return level;
}

/// Calls visit for all cells, and some outside.
template <class Visit>
void for_each(const CellLevel& level, const Visit& visit) {
  for (int z = -1; z <= level.size.z; ++z)
    for (int y = -1; y <= level.size.y; ++y)
      for (int x = -1; x <= level.size.x; ++x) visit(Index3(x, y, z));
}

TEST(CellLevel, FindsACellAtItsPlace) {
  for (const CellLevel& level : {some_cells(), highest_level()}) {
    std::size_t found = 0;
    for_each(level, [&](const Index3& i) {
      const std::uint32_t place = level.place(i);
      if (place == CellLevel::kNone) return;
      ++found;
      EXPECT_EQ(level.at(place), i);
    });
    // Of the eight below cell 11, the last one, two lie inside; of those below cell 6 the four of z = 2.
    EXPECT_EQ(found, level.size_above.x == 0 ? level.count() : 22u);
  }
}

TEST(CellLevel, FindsTheCellsAroundOneAtTheirPlaces) {
  for (const CellLevel& level : {some_cells(), highest_level()}) {
    for_each(level, [&](const Index3& i) {
      if (!inside(i, level.size)) return;
      const auto around = level.places_around(i);
      for (int q = 0; q < 27; ++q) {
        const Index3 near = i + Index3(q % 3 - 1, q / 3 % 3 - 1, q / 9 - 1);
        EXPECT_EQ(around[std::size_t(q)] == CellLevel::kNone || !inside(near, level.size) ? CellLevel::kNone
                                                                                          : around[std::size_t(q)],
                  level.place(near));
      }
    });
  }
}

}  // namespace
}  // namespace isolux::test
