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

/// The bricks that a grid point belongs to on one axis: the last point of a brick of cells is the first of the next.
struct BrickRun {
  int first;
  int last;
};
BrickRun bricks_of_point(int point, int bricks, int shift) {
  return {.first = point > 0 ? (point - 1) >> shift : 0, .last = std::min(point >> shift, bricks - 1)};
}

// Row by row, each row reduced along x once.
void fill_from_voxels(Macrocells::Level& level, const Volume& volume) {
  const Index3 size = volume.lattice().size;
  std::vector<float> low(std::size_t(level.size.x));
  std::vector<float> high(low.size());
  const float* row = volume.values.values().data();
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j, row += size.x) {
      for (int b = 0; b < level.size.x; ++b) {
        const int begin = b << level.shift;
        const int last = std::min(begin + (1 << level.shift), size.x - 1);
        float least = row[begin];
        float greatest = row[begin];
        for (int i = begin + 1; i <= last; ++i) {
          least = std::min(least, row[i]);
          greatest = std::max(greatest, row[i]);
        }
        low[std::size_t(b)] = least;
        high[std::size_t(b)] = greatest;
      }
      const BrickRun ys = bricks_of_point(j, level.size.y, level.shift);
      const BrickRun zs = bricks_of_point(k, level.size.z, level.shift);
      for (int z = zs.first; z <= zs.last; ++z) {
        for (int y = ys.first; y <= ys.last; ++y) {
          const int cell[3] = {0, y << level.shift, z << level.shift};
          const std::size_t first = level.offset(cell);
          for (std::size_t b = 0; b < low.size(); ++b) widen(level, first + b, low[b], high[b]);
        }
      }
    }
  }
}

void fill_from_finer(Macrocells::Level& level, const Macrocells::Level& finer) {
  std::size_t brick = 0;
  for (int z = 0; z < finer.size.z; ++z) {
    for (int y = 0; y < finer.size.y; ++y) {
      for (int x = 0; x < finer.size.x; ++x, ++brick) {
        const int cell[3] = {x << finer.shift, y << finer.shift, z << finer.shift};
        widen(level, level.offset(cell), finer.low[brick], finer.high[brick]);
      }
    }
  }
}

}  // namespace

Macrocells::Macrocells(const Volume& volume) {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    levels_[i] = empty_level(volume.lattice().size - 1, kShifts[i]);
    if (i == 0) {
      fill_from_voxels(levels_[i], volume);
    } else {
      fill_from_finer(levels_[i], levels_[i - 1]);
    }
  }
}

}  // namespace isolux
