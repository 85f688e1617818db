#include "macrocells.h"

#include <algorithm>
#include <limits>

namespace isolux {
namespace {

Macrocells::Level empty_level(Index3 cells, int shift) {
  Macrocells::Level level;
  level.shift = shift;
  for (int a = 0; a < 3; ++a) level.size[a] = ((cells[a] - 1) >> shift) + 1;
  const std::size_t count = std::size_t(level.size.x) * std::size_t(level.size.y) * std::size_t(level.size.z);
  level.low.assign(count, std::numeric_limits<float>::infinity());
  level.high.assign(count, -std::numeric_limits<float>::infinity());
  return level;
}

void widen(Macrocells::Level& level, std::size_t brick, float low, float high) {
  level.low[brick] = std::min(level.low[brick], low);
  level.high[brick] = std::max(level.high[brick], high);
}

// The bricks of a row of grid points: the last point of a brick of cells is the first of the next one.
struct BrickRun {
  int first;
  int last;
};
BrickRun bricks_of_point(int point, int bricks, int shift) {
  return {.first = point > 0 ? (point - 1) >> shift : 0, .last = std::min(point >> shift, bricks - 1)};
}

}  // namespace

Macrocells::Macrocells(const Volume& volume) {
  const Index3 size = volume.lattice().size;
  fine_ = empty_level(size - 1, kFineShift);
  coarse_ = empty_level(size - 1, kCoarseShift);
  std::vector<float> low(std::size_t(fine_.size.x));
  std::vector<float> high(low.size());
  const float* row = volume.values.values().data();
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j, row += size.x) {
      for (int b = 0; b < fine_.size.x; ++b) {
        const int begin = b << kFineShift;
        const int end = std::min(begin + (1 << kFineShift), size.x - 1) + 1;
        const auto [least, greatest] = std::minmax_element(row + begin, row + end);
        low[std::size_t(b)] = *least;
        high[std::size_t(b)] = *greatest;
      }
      const BrickRun ys = bricks_of_point(j, fine_.size.y, kFineShift);
      const BrickRun zs = bricks_of_point(k, fine_.size.z, kFineShift);
      for (int z = zs.first; z <= zs.last; ++z) {
        for (int y = ys.first; y <= ys.last; ++y) {
          const int cell[3] = {0, y << kFineShift, z << kFineShift};
          const std::size_t first = fine_.offset(cell);
          for (std::size_t b = 0; b < low.size(); ++b) widen(fine_, first + b, low[b], high[b]);
        }
      }
    }
  }
  std::size_t brick = 0;
  for (int z = 0; z < fine_.size.z; ++z) {
    for (int y = 0; y < fine_.size.y; ++y) {
      for (int x = 0; x < fine_.size.x; ++x, ++brick) {
        const int cell[3] = {x << kFineShift, y << kFineShift, z << kFineShift};
        widen(coarse_, coarse_.offset(cell), fine_.low[brick], fine_.high[brick]);
      }
    }
  }
}

}  // namespace isolux
