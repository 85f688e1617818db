#include <isolux/core/parallel.h>
#include <isolux/core/release.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "grid_index.h"
#include "texel_pyramid.h"

namespace isolux {
namespace {

constexpr double kOwnWeight = 0.125;
/// A cell whose own differences are so many times what noise explains is judged by itself: an edge runs through it.
constexpr double kClear = 4.0;

constexpr float kNoLight = -1.0f;

/// Of this size, whatever it held: never two of them at a time.
template <class T>
void renew(std::vector<T>& values, std::size_t size) {
  if (values.capacity() < size) release(values);
  values.resize(size);
}

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

void TexelPyramid::differ(std::size_t place) {
  static const std::array<Pair, 13> pairs = make_pairs();
  const Index3 at = index_of(texels_.size, traced_texels_[place]);
  const int step = stride(level_[traced_texels_[place]]);
  const auto traced = [&](const Index3& i) {
    if (!inside(i, texels_.size)) return place;
    const std::uint32_t number = numbers_[texels_.offset(i.x, i.y, i.z)];
    return number < kLit ? std::size_t(number) : place;
  };
  double weight = kOwnWeight;
  double noise = 0.0;
  std::array<double, 3> sum{};
  for (std::size_t c = 0; c < channels_; ++c) sum[c] = kOwnWeight * double(traced_.light[place * channels_ + c]);
  for (const Pair& pair : pairs) {
    const std::size_t up = traced(at + pair.step * step);
    const std::size_t down = traced(at - pair.step * step);
    if (up == place || down == place) continue;
    weight += pair.weight;
    noise += 0.25 * pair.weight * pair.weight * (double(traced_.variance[up]) + double(traced_.variance[down]));
    for (std::size_t c = 0; c < channels_; ++c) {
      sum[c] +=
          0.5 * pair.weight * (double(traced_.light[up * channels_ + c]) + double(traced_.light[down * channels_ + c]));
    }
  }
  for (std::size_t c = 0; c < channels_; ++c)
    difference_[place * channels_ + c] = float(double(traced_.light[place * channels_ + c]) - sum[c] / weight);
  const double own = 1.0 - kOwnWeight / weight;
  noise_[place] = float(own * own * double(traced_.variance[place]) + noise / (weight * weight));
}

void TexelPyramid::sum_corners(int l, std::size_t place) {
  double roughness = 0.0;
  double noise = 0.0;
  int count = 0;
  for (const std::size_t texel : corners({.level = l, .at = levels_[std::size_t(l)].at(place)})) {
    const std::uint32_t number = numbers_[texel];
    if (number >= kLit) continue;
    ++count;
    for (std::size_t v = number * channels_; v < (number + 1) * channels_; ++v)
      roughness += double(difference_[v]) * double(difference_[v]) / double(channels_);
    noise += double(noise_[number]);
  }
  levels_[std::size_t(l)].raw[place] =
      count == 0 ? Figures{.noise = kNoLight}
                 : Figures{.roughness = float(roughness / count), .noise = float(noise / count)};
}

void TexelPyramid::sum_neighbours(int l, std::size_t place) {
  CellLevel& level = levels_[std::size_t(l)];
  const Figures& own = level.raw[place];
  double roughness = 0.0;
  double noise = 0.0;
  int count = 0;
  for (const std::uint32_t p : level.places_around(level.at(place))) {
    if (p == CellLevel::kNone || level.leaf[p] == 0 || level.raw[p].noise < 0.0f) continue;
    ++count;
    roughness += double(level.raw[p].roughness);
    noise += double(level.raw[p].noise);
  }
  const double n = std::max(count, 1);
  double rough = (roughness - noise) / n;
  if (own.roughness > kClear * own.noise) rough = std::max(rough, double(own.roughness) - double(own.noise));
  level.figures[place] = {.roughness = float(std::max(0.0, rough)), .noise = float(noise / n)};
}

void TexelPyramid::update(const Traced& traced, const Run& run) {
  traced_ = traced;
  if (is_all_traced_) return;
  renew(difference_, traced_.light.size());
  renew(noise_, traced_texels_.size());
  parallel_blocks(traced_texels_.size(), kBlock, run, "", [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) differ(i);
  });
  for (CellLevel& level : levels_) {
    renew(level.raw, level.leaf.size());
    renew(level.figures, level.leaf.size());
  }
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
    const CellLevel& level = levels_[std::size_t(l)];
    for (std::size_t c = 0; c < level.leaf.size(); ++c) {
      if (level.leaf[c] == 0 || level.raw[c].noise < 0.0f) continue;
      const Figures& figures = level.figures[c];
      visit({.level = l, .at = level.at(c)}, {.roughness = double(figures.roughness), .noise = double(figures.noise)});
    }
  }
}

CellFigures TexelPyramid::figures_at(std::size_t texel) const {
  const int l = level_[texel];
  const CellLevel& level = levels_[std::size_t(l)];
  const Index3 low = (index_of(texels_.size, texel) + stride(l) - 1) / stride(l) - 1;
  CellFigures sum;
  int count = 0;
  for (int c = 0; c < 8; ++c) {
    const std::uint32_t p = level.place(low + corner_step(c));
    if (p == CellLevel::kNone || level.leaf[p] == 0) continue;
    ++count;
    sum.roughness += double(level.figures[p].roughness);
    sum.noise += double(level.figures[p].noise);
  }
  if (count == 0) return {};
  return {.roughness = sum.roughness / count, .noise = sum.noise / count};
}

void TexelPyramid::for_each_traced(
    const Run& run, const std::function<void(std::size_t place, int level, const CellFigures&)>& visit) const {
  // A few blocks at a time: figures on all threads, visits in order.
  constexpr std::size_t kTogether = 64 * kBlock;
  const std::size_t all = traced_texels_.size();
  std::vector<CellFigures> figures(std::min(kTogether, all));
  for (std::size_t first = 0; first < all; first += kTogether) {
    const std::size_t count = std::min(kTogether, all - first);
    parallel_blocks(count, kBlock, run, "", [&](const Block& block) {
      for (std::size_t i = block.begin; i < block.end; ++i) {
        figures[i] = figures_at(traced_texels_[first + i]);
        figures[i].noise = 0.5 * (figures[i].noise + double(noise_[first + i]));
      }
    });
    for (std::size_t i = 0; i < count; ++i) visit(first + i, level_[traced_texels_[first + i]], figures[i]);
  }
}

}  // namespace isolux
