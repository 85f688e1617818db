#include <isolux/resample/light_bricks.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace isolux {
namespace {

// Of a texel. Points of a cell's face round to either side, in a shader's single precision by 1e-4 texel in 1000.
constexpr double kMargin = 1e-3;

/// Marks the pages that reading at points of voxel cells [first, last] touches.
void mark(LightBricks& bricks, const Index3& texels, const IndexToWorld& to_texels, const Index3& cell) {
  const Vec3 one = to_texels.world(Vec3(cell));
  const Vec3 other = to_texels.world(Vec3(cell + 1));
  Index3 low;
  Index3 high;
  for (int a = 0; a < 3; ++a) {
    const double last_cell = std::max(texels[a] - 2, 0);
    low[a] = int(std::clamp(std::floor(std::min(one[a], other[a]) - kMargin), 0.0, last_cell)) / LightBricks::kCells;
    high[a] = int(std::clamp(std::floor(std::max(one[a], other[a]) + kMargin), 0.0, last_cell)) / LightBricks::kCells;
  }
  for (int k = low.z; k <= high.z; ++k)
    for (int j = low.y; j <= high.y; ++j)
      for (int i = low.x; i <= high.x; ++i) bricks.slots[bricks.page_of({i, j, k})] = 0;
}

void mark_range(LightBricks& bricks, const Volume& volume, const Lattice& texels, const ValueRange& isovalues) {
  const Grid<float>& f = volume.values;
  const IndexToWorld to_texels = index_to_index(volume.lattice(), texels);
  const Index3 cells = volume.lattice().size - 1;
  for (int k = 0; k < cells.z; ++k) {
    for (int j = 0; j < cells.y; ++j) {
      for (int i = 0; i < cells.x; ++i) {
        const auto [low, high] =
            std::minmax({f(i, j, k), f(i + 1, j, k), f(i, j + 1, k), f(i + 1, j + 1, k), f(i, j, k + 1),
                         f(i + 1, j, k + 1), f(i, j + 1, k + 1), f(i + 1, j + 1, k + 1)});
        if (low < high && low <= isovalues.high && high >= isovalues.low)
          mark(bricks, texels.size, to_texels, {i, j, k});
      }
    }
  }
}

/// Appends the texels of one page, if there are any.
void append_brick(const Lattice& texels, int channels, const Index3& page, const std::vector<float>& from,
                  std::vector<float>& to) {
  if (from.empty()) return;
  const Index3 last = texels.size - 1;
  for (int k = 0; k < LightBricks::kTexels; ++k) {
    for (int j = 0; j < LightBricks::kTexels; ++j) {
      for (int i = 0; i < LightBricks::kTexels; ++i) {
        const Index3 t = glm::min(page * LightBricks::kCells + Index3(i, j, k), last);
        const float* texel = &from[texels.offset(t.x, t.y, t.z) * std::size_t(channels)];
        to.insert(to.end(), texel, texel + channels);
      }
    }
  }
}

}  // namespace

LightBricks make_light_bricks(const Volume& volume, const IlluminationGrid& light, const ValueRange& isovalues) {
  require_complete(light);
  LightBricks bricks;
  bricks.channels = light.channels;
  const Lattice& texels = light.lattice;
  for (int a = 0; a < 3; ++a) {
    bricks.pages[a] = (std::max(texels.size[a] - 1, 1) + LightBricks::kCells - 1) / LightBricks::kCells;
  }
  bricks.slots.assign(std::size_t(bricks.pages.x) * std::size_t(bricks.pages.y) * std::size_t(bricks.pages.z),
                      LightBricks::kAbsent);
  mark_range(bricks, volume, texels, isovalues);
  std::uint32_t next = 0;
  for (int k = 0; k < bricks.pages.z; ++k) {
    for (int j = 0; j < bricks.pages.y; ++j) {
      for (int i = 0; i < bricks.pages.x; ++i) {
        std::uint32_t& slot = bricks.slots[bricks.page_of({i, j, k})];
        if (slot == LightBricks::kAbsent) continue;
        slot = next++;
        append_brick(texels, light.channels, {i, j, k}, light.values, bricks.values);
        append_brick(texels, light.channels, {i, j, k}, light.detail.slopes, bricks.slopes);
        for (unsigned a = 0; a < 3; ++a)
          append_brick(texels, light.channels, {i, j, k}, light.detail.normal_slopes[a], bricks.normal_slopes[a]);
      }
    }
  }
  return bricks;
}

}  // namespace isolux
