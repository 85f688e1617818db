#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "grid_index.h"
#include "texel_pyramid.h"

namespace isolux {
namespace {

constexpr double kOwnWeight = 0.125;
/// A cell whose own differences are so many times what noise explains is judged by itself: an edge runs through it.
constexpr double kClear = 4.0;

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
    if (site_[texel] != Site::kLit) continue;
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
    for (std::size_t c = 0; c < level.leaf.size(); ++c) {
      if (level.leaf[c] != 0 && level.raw[c].rays > 0.0) visit(cell_of(l, std::uint32_t(c)), level.figures[c]);
    }
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

void TexelPyramid::for_each_traced(
    const Run& run, const std::function<void(std::size_t texel, int level, const CellFigures&)>& visit) const {
  // A few blocks at a time: figures on all threads, visits in order.
  constexpr std::size_t kTogether = 64 * kBlock;
  std::vector<CellFigures> figures(std::min(kTogether, texels_.count()));
  for (std::size_t first = 0; first < texels_.count(); first += kTogether) {
    const std::size_t count = std::min(kTogether, texels_.count() - first);
    parallel_blocks(count, kBlock, run, "", [&](const Block& block) {
      for (std::size_t i = block.begin; i < block.end; ++i) {
        const std::size_t texel = first + i;
        if (level_[texel] < 0) continue;
        figures[i] = figures_at(texel);
        figures[i].noise = 0.5 * (figures[i].noise + double(noise_[texel]));
        figures[i].rays = double(traced_.rays[texel]);
      }
    });
    for (std::size_t i = 0; i < count; ++i)
      if (level_[first + i] >= 0) visit(first + i, level_[first + i], figures[i]);
  }
}

}  // namespace isolux
