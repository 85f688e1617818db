#include "texel_pyramid.h"

#include <isolux/core/release.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <utility>

#include "grid_index.h"

namespace isolux {
namespace {

/// Coarse cells whose corners are asked for at once: bounds the memory that their children take.
constexpr std::size_t kCellsAtOnce = 4096;

}  // namespace

TexelPyramid::TexelPyramid(const Lattice& texels, int channels, FindLit find_lit)
    : texels_(texels),
      channels_(std::size_t(channels)),
      find_lit_(std::move(find_lit)),
      numbers_(texels.count(), kUnknown),
      level_(texels.count(), std::int8_t(-1)) {
  for (int l = 0; l < kLevels; ++l) {
    CellLevel& level = levels_[std::size_t(l)];
    level.size = glm::max((texels.size - 2 + stride(l)) / stride(l), Index3(1));
    if (l == 0) continue;
    level.size_above = levels_[std::size_t(l) - 1].size;
    level.first.assign(levels_[std::size_t(l) - 1].count(), CellLevel::kNone);
  }
  const std::size_t coarse = levels_[0].count();
  levels_[0].leaf.assign(coarse, 0);
  for (std::size_t begin = 0; begin < coarse; begin += kCellsAtOnce) {
    std::vector<Cell> cells;
    for (std::size_t c = begin; c < std::min(coarse, begin + kCellsAtOnce); ++c)
      cells.push_back(cell_of(0, std::uint32_t(c)));
    make_leaves(cells);
  }
}

TexelPyramid::Cell TexelPyramid::cell_of(int level, std::uint32_t number) const {
  return {.level = level, .at = index_of(levels_[std::size_t(level)].size, number)};
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
  return std::all_of(at.begin(), at.end(), [&](std::size_t t) { return is_lit(t); });
}

std::size_t TexelPyramid::texels_of(const Cell& cell) const {
  const Index3 n = glm::max(last_texel(cell) - first_texel(cell), Index3(1));
  return std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z);
}

void TexelPyramid::find_sites(std::vector<std::size_t> unknown) {
  if (unknown.empty()) return;
  const std::vector<std::uint8_t> is_lit = find_lit_(unknown);
  for (std::size_t i = 0; i < unknown.size(); ++i) numbers_[unknown[i]] = is_lit[i] != 0 ? kLit : kUnlit;
}

void TexelPyramid::ask(std::span<const Cell> cells) {
  std::vector<std::size_t> unknown;
  for (const Cell& cell : cells) {
    for (const std::size_t texel : corners(cell)) {
      if (numbers_[texel] != kUnknown) continue;
      numbers_[texel] = kLit;  // once
      unknown.push_back(texel);
    }
  }
  std::sort(unknown.begin(), unknown.end());
  find_sites(std::move(unknown));
}

void TexelPyramid::add_children(const Cell& cell, std::vector<Cell>& children) {
  CellLevel& level = levels_[std::size_t(cell.level)];
  level.leaf[level.place(cell.at)] = 0;
  CellLevel& finer = levels_[std::size_t(cell.level) + 1];
  finer.add_below(level.number(cell.at));
  for (int c = 0; c < 8; ++c) {
    const Cell child{.level = cell.level + 1, .at = cell.at * 2 + corner_step(c)};
    if (inside(child.at, finer.size)) children.push_back(child);
  }
}

void TexelPyramid::want(std::size_t texel, int level) {
  if (level_[texel] < 0) wanted_.push_back(texel);
  level_[texel] = std::max(level_[texel], std::int8_t(level));
}

void TexelPyramid::make_leaves(std::span<const Cell> cells) {
  if (cells.empty()) return;
  ask(cells);
  std::vector<Cell> finer;
  for (const Cell& cell : cells) {
    if (cell.level + 1 < kLevels && !has_all_corners(cell)) {
      add_children(cell, finer);
      continue;
    }
    CellLevel& level = levels_[std::size_t(cell.level)];
    level.leaf[level.place(cell.at)] = 1;
    for (const std::size_t texel : corners(cell))
      if (is_lit(texel)) want(texel, cell.level);
  }
  make_leaves(finer);
}

void TexelPyramid::refine(std::span<const Cell> cells) {
  for (std::size_t begin = 0; begin < cells.size(); begin += kCellsAtOnce) {
    std::vector<Cell> children;
    for (const Cell& cell : cells.subspan(begin, std::min(kCellsAtOnce, cells.size() - begin)))
      add_children(cell, children);
    make_leaves(children);
  }
}

void TexelPyramid::refine_all() {
  is_all_traced_ = true;
  levels_ = {};
  release(difference_);
  release(noise_);
  constexpr std::size_t kTexelsAtOnce = 64 * kBlock;
  for (std::size_t begin = 0; begin < numbers_.size(); begin += kTexelsAtOnce) {
    const std::size_t end = std::min(numbers_.size(), begin + kTexelsAtOnce);
    std::vector<std::size_t> unknown;
    for (std::size_t t = begin; t < end; ++t)
      if (numbers_[t] == kUnknown) unknown.push_back(t);
    find_sites(std::move(unknown));
    for (std::size_t t = begin; t < end; ++t)
      if (is_lit(t)) want(t, kLevels - 1);
  }
}

std::vector<std::size_t> TexelPyramid::wanted() {
  if (!std::is_sorted(wanted_.begin(), wanted_.end())) std::sort(wanted_.begin(), wanted_.end());
  for (const std::size_t texel : wanted_) {
    numbers_[texel] = std::uint32_t(traced_texels_.size());
    traced_texels_.push_back(std::uint32_t(texel));
  }
  return std::exchange(wanted_, {});
}

std::vector<std::uint8_t> TexelPyramid::lit() const {
  std::vector<std::uint8_t> flags(numbers_.size());
  std::transform(numbers_.begin(), numbers_.end(), flags.begin(),
                 [](std::uint32_t n) { return std::uint8_t(n != kUnlit); });
  return flags;
}

}  // namespace isolux
