#include "texel_pyramid.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

namespace isolux {
namespace {

constexpr std::size_t kBlock = 8192;
constexpr double kOwnWeight = 0.125;
/// A cell whose own differences are so many times what noise explains is judged by itself: an edge runs through it.
constexpr double kClear = 4.0;

Index3 index_of(const Index3& size, std::size_t offset) {
  const auto nx = std::size_t(size.x);
  const auto ny = std::size_t(size.y);
  return {int(offset % nx), int(offset / nx % ny), int(offset / nx / ny)};
}

bool inside(const Index3& i, const Index3& size) {
  return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < size.x && i.y < size.y && i.z < size.z;
}

Index3 corner_step(int corner) { return {corner & 1, corner >> 1 & 1, corner >> 2 & 1}; }

/// One of two opposite neighbours, and the weight of the pair in a mean by (1/4, 1/2, 1/4) on each axis.
struct Pair {
  Index3 step{0};
  double weight = 0.0;
};

std::array<Pair, 13> make_pairs() {
  std::array<Pair, 13> pairs;
  for (int q = 14; q < 27; ++q) {
    const Index3 step{q % 3 - 1, q / 3 % 3 - 1, q / 9 - 1};
    const int axes = std::abs(step.x) + std::abs(step.y) + std::abs(step.z);
    pairs[std::size_t(q - 14)] = {.step = step, .weight = 0.25 / double(1 << axes)};
  }
  return pairs;
}

}  // namespace

TexelPyramid::TexelPyramid(const Lattice& texels, int channels, std::vector<std::uint8_t> has_site)
    : texels_(texels),
      channels_(std::size_t(channels)),
      has_site_(std::move(has_site)),
      level_(texels.count(), std::int8_t(-1)),
      difference_(texels.count() * channels_),
      noise_(texels.count()) {
  traced_ = {.light = std::vector<float>(texels.count() * channels_),
             .variance = std::vector<float>(texels.count()),
             .rays = std::vector<std::uint32_t>(texels.count())};
  for (int l = 0; l < kLevels; ++l) {
    Level& level = levels_[std::size_t(l)];
    level.size = glm::max((texels.size - 2 + stride(l)) / stride(l), Index3(1));
    const Index3& n = level.size;
    const std::size_t cells = std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z);
    level.leaf.assign(cells, 0);
    level.raw.resize(cells);
    level.figures.resize(cells);
  }
  for (std::size_t c = 0; c < levels_[0].leaf.size(); ++c) make_leaf({.level = 0, .at = index_of(levels_[0].size, c)});
}

Index3 TexelPyramid::first_texel(const Cell& cell) const {
  return glm::min(cell.at * stride(cell.level), texels_.size - 1);
}

Index3 TexelPyramid::last_texel(const Cell& cell) const {
  return glm::min((cell.at + 1) * stride(cell.level), texels_.size - 1);
}

std::array<std::size_t, 8> TexelPyramid::corners(const Cell& cell) const {
  const Index3 ends[2] = {first_texel(cell), last_texel(cell)};
  std::array<std::size_t, 8> result{};
  for (int c = 0; c < 8; ++c) {
    const Index3 s = corner_step(c);
    result[std::size_t(c)] = texels_.offset(ends[s.x].x, ends[s.y].y, ends[s.z].z);
  }
  return result;
}

bool TexelPyramid::has_all_corners(const Cell& cell) const {
  const auto at = corners(cell);
  return std::all_of(at.begin(), at.end(), [&](std::size_t t) { return has_site_[t] != 0; });
}

std::size_t TexelPyramid::texels_of(const Cell& cell) const {
  const Index3 n = glm::max(last_texel(cell) - first_texel(cell), Index3(1));
  return std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z);
}

void TexelPyramid::make_leaf(const Cell& cell) {
  Level& level = levels_[std::size_t(cell.level)];
  if (cell.level + 1 < kLevels && !has_all_corners(cell)) {
    refine(cell);
    return;
  }
  level.leaf[level.offset(cell.at)] = 1;
  for (const std::size_t texel : corners(cell)) {
    if (has_site_[texel] == 0) continue;
    if (level_[texel] < 0) wanted_.push_back(texel);
    level_[texel] = std::max(level_[texel], std::int8_t(cell.level));
  }
}

void TexelPyramid::refine(const Cell& cell) {
  Level& level = levels_[std::size_t(cell.level)];
  level.leaf[level.offset(cell.at)] = 0;
  for (int c = 0; c < 8; ++c) {
    const Cell child{.level = cell.level + 1, .at = cell.at * 2 + corner_step(c)};
    if (inside(child.at, levels_[std::size_t(child.level)].size)) make_leaf(child);
  }
}

std::vector<std::size_t> TexelPyramid::wanted() {
  std::sort(wanted_.begin(), wanted_.end());
  return std::exchange(wanted_, {});
}

void TexelPyramid::differ(std::size_t texel) {
  static const std::array<Pair, 13> pairs = make_pairs();
  const Index3 at = index_of(texels_.size, texel);
  const int step = stride(level_[texel]);
  const auto traced = [&](const Index3& i) {
    if (!inside(i, texels_.size)) return texel;
    const std::size_t t = texels_.offset(i.x, i.y, i.z);
    return level_[t] >= 0 ? t : texel;
  };
  double weight = kOwnWeight;
  double noise = 0.0;
  std::array<double, 3> sum{};
  for (std::size_t c = 0; c < channels_; ++c) sum[c] = kOwnWeight * double(traced_.light[texel * channels_ + c]);
  for (const Pair& pair : pairs) {
    const std::size_t up = traced(at + pair.step * step);
    const std::size_t down = traced(at - pair.step * step);
    if (up == texel || down == texel) continue;
    weight += pair.weight;
    noise += 0.25 * pair.weight * pair.weight * (double(traced_.variance[up]) + double(traced_.variance[down]));
    for (std::size_t c = 0; c < channels_; ++c) {
      sum[c] +=
          0.5 * pair.weight * (double(traced_.light[up * channels_ + c]) + double(traced_.light[down * channels_ + c]));
    }
  }
  for (std::size_t c = 0; c < channels_; ++c)
    difference_[texel * channels_ + c] = float(double(traced_.light[texel * channels_ + c]) - sum[c] / weight);
  const double own = 1.0 - kOwnWeight / weight;
  noise_[texel] = float(own * own * double(traced_.variance[texel]) + noise / (weight * weight));
}

void TexelPyramid::sum_corners(int l, std::size_t c) {
  Level& level = levels_[std::size_t(l)];
  CellFigures& sum = level.raw[c];
  sum = {};
  int count = 0;
  for (const std::size_t texel : corners({.level = l, .at = index_of(level.size, c)})) {
    if (has_site_[texel] == 0) continue;
    ++count;
    for (std::size_t v = texel * channels_; v < (texel + 1) * channels_; ++v)
      sum.roughness += double(difference_[v]) * double(difference_[v]) / double(channels_);
    sum.noise += double(noise_[texel]);
    sum.rays += double(traced_.rays[texel]);
  }
  if (count == 0) return;
  sum = {.roughness = sum.roughness / count, .noise = sum.noise / count, .rays = sum.rays / count};
}

void TexelPyramid::sum_neighbours(int l, std::size_t c) {
  Level& level = levels_[std::size_t(l)];
  const Index3 at = index_of(level.size, c);
  const CellFigures& own = level.raw[c];
  CellFigures sum;
  int count = 0;
  for (int q = 0; q < 27; ++q) {
    const Index3 i = at + Index3(q % 3 - 1, q / 3 % 3 - 1, q / 9 - 1);
    if (!inside(i, level.size) || level.leaf[level.offset(i)] == 0) continue;
    const CellFigures& near = level.raw[level.offset(i)];
    if (near.rays == 0.0) continue;
    ++count;
    sum.roughness += near.roughness;
    sum.noise += near.noise;
  }
  const double n = std::max(count, 1);
  double rough = (sum.roughness - sum.noise) / n;
  if (own.roughness > kClear * own.noise) rough = std::max(rough, own.roughness - own.noise);
  level.figures[c] = {.roughness = std::max(0.0, rough), .noise = sum.noise / n, .rays = own.rays};
}

void TexelPyramid::update(const Run& run) {
  parallel_blocks(texels_.count(), kBlock, run, "", [&](const Block& block) {
    for (std::size_t t = block.begin; t < block.end; ++t)
      if (level_[t] >= 0) differ(t);
  });
  using Pass = void (TexelPyramid::*)(int, std::size_t);
  for (const Pass pass : {&TexelPyramid::sum_corners, &TexelPyramid::sum_neighbours}) {
    for (int l = 0; l < kLevels; ++l) {
      const auto& leaf = levels_[std::size_t(l)].leaf;
      parallel_blocks(leaf.size(), kBlock, run, "", [&](const Block& block) {
        for (std::size_t c = block.begin; c < block.end; ++c)
          if (leaf[c] != 0) (this->*pass)(l, c);
      });
    }
  }
}

void TexelPyramid::for_each_cell(const std::function<void(const Cell&, const CellFigures&)>& visit) const {
  for (int l = 0; l < kLevels; ++l) {
    const Level& level = levels_[std::size_t(l)];
    for (std::size_t c = 0; c < level.leaf.size(); ++c)
      if (level.leaf[c] != 0 && level.raw[c].rays > 0.0)
        visit({.level = l, .at = index_of(level.size, c)}, level.figures[c]);
  }
}

CellFigures TexelPyramid::figures_at(std::size_t texel) const {
  const int l = level_[texel];
  const Level& level = levels_[std::size_t(l)];
  const Index3 low = (index_of(texels_.size, texel) + stride(l) - 1) / stride(l) - 1;
  CellFigures sum;
  int count = 0;
  for (int c = 0; c < 8; ++c) {
    const Index3 i = low + corner_step(c);
    if (!inside(i, level.size) || level.leaf[level.offset(i)] == 0) continue;
    const CellFigures& figures = level.figures[level.offset(i)];
    ++count;
    sum.roughness += figures.roughness;
    sum.noise += figures.noise;
  }
  if (count == 0) return {};
  return {.roughness = sum.roughness / count, .noise = sum.noise / count};
}

template <class Visit>
void TexelPyramid::for_each_texel(const Cell& cell, const Visit& visit) const {
  const Index3 first = first_texel(cell);
  const Index3 last = last_texel(cell);
  // Texels on a face between cells belong to the upper one, at the box's end to the lower.
  Index3 end = last - 1;
  for (int a = 0; a < 3; ++a)
    if (last[a] == texels_.size[a] - 1) end[a] = last[a];
  const Vec3 size(glm::max(last - first, Index3(1)));
  for (int z = first.z; z <= end.z; ++z) {
    for (int y = first.y; y <= end.y; ++y) {
      for (int x = first.x; x <= end.x; ++x) visit(texels_.offset(x, y, z), Vec3(Index3(x, y, z) - first) / size);
    }
  }
}

void TexelPyramid::predict(const Cell& cell, const std::vector<float>& smooth, std::vector<float>& light) const {
  const auto at = corners(cell);
  for_each_texel(cell, [&](std::size_t texel, const Vec3& u) {
    if (level_[texel] >= 0 || has_site_[texel] == 0) return;
    std::array<double, 3> sum{};
    for (int c = 0; c < 8; ++c) {
      const Index3 s = corner_step(c);
      double w = 1.0;
      for (int a = 0; a < 3; ++a) w *= s[a] != 0 ? u[a] : 1.0 - u[a];
      for (std::size_t k = 0; k < channels_; ++k) sum[k] += w * double(smooth[at[std::size_t(c)] * channels_ + k]);
    }
    for (std::size_t k = 0; k < channels_; ++k) light[texel * channels_ + k] = float(sum[k]);
  });
}

std::vector<float> TexelPyramid::of_cells(const std::function<float(const Cell&, const CellFigures&)>& figure) const {
  std::vector<float> result(texels_.count());
  for_each_cell([&](const Cell& cell, const CellFigures& figures) {
    const float value = figure(cell, figures);
    for_each_texel(cell, [&](std::size_t texel, const Vec3&) { result[texel] = value; });
  });
  return result;
}

std::vector<float> TexelPyramid::light(const Run& run) const {
  std::vector<float> smooth(traced_.light.size());
  parallel_blocks(texels_.count(), kBlock, run, "", [&](const Block& block) {
    for (std::size_t t = block.begin; t < block.end; ++t) {
      if (level_[t] < 0) continue;
      const double taken = 1.0 - figures_at(t).kept();
      for (std::size_t v = t * channels_; v < (t + 1) * channels_; ++v)
        smooth[v] = std::max(0.0f, float(double(traced_.light[v]) - taken * double(difference_[v])));
    }
  });
  std::vector<float> light = smooth;
  for (int l = 0; l + 1 < kLevels; ++l) {
    const Level& level = levels_[std::size_t(l)];
    parallel_blocks(level.leaf.size(), kBlock, run, "", [&](const Block& block) {
      for (std::size_t c = block.begin; c < block.end; ++c)
        if (level.leaf[c] != 0) predict({.level = l, .at = index_of(level.size, c)}, smooth, light);
    });
  }
  return light;
}

}  // namespace isolux
