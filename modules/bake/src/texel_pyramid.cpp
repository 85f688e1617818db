#include "texel_pyramid.h"

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
      site_(texels.count(), Site::kUnknown),
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
  const std::size_t coarse = levels_[0].leaf.size();
  for (std::size_t begin = 0; begin < coarse; begin += kCellsAtOnce) {
    std::vector<Cell> cells;
    for (std::size_t c = begin; c < std::min(coarse, begin + kCellsAtOnce); ++c)
      cells.push_back(cell_of(0, std::uint32_t(c)));
    make_leaves(cells);
  }
}

std::uint32_t TexelPyramid::number_of(const Cell& cell) const {
  return std::uint32_t(levels_[std::size_t(cell.level)].offset(cell.at));
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
  return std::all_of(at.begin(), at.end(), [&](std::size_t t) { return site_[t] == Site::kLit; });
}

std::size_t TexelPyramid::texels_of(const Cell& cell) const {
  const Index3 n = glm::max(last_texel(cell) - first_texel(cell), Index3(1));
  return std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z);
}

void TexelPyramid::ask(std::span<const Cell> cells) {
  std::vector<std::size_t> unknown;
  for (const Cell& cell : cells) {
    for (const std::size_t texel : corners(cell))
      if (site_[texel] == Site::kUnknown) unknown.push_back(texel);
  }
  std::sort(unknown.begin(), unknown.end());
  unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
  if (unknown.empty()) return;
  const std::vector<std::uint8_t> is_lit = find_lit_(unknown);
  for (std::size_t i = 0; i < unknown.size(); ++i) site_[unknown[i]] = is_lit[i] != 0 ? Site::kLit : Site::kUnlit;
}

void TexelPyramid::add_children(const Cell& cell, std::vector<Cell>& children) {
  Level& level = levels_[std::size_t(cell.level)];
  level.leaf[level.offset(cell.at)] = 0;
  for (int c = 0; c < 8; ++c) {
    const Cell child{.level = cell.level + 1, .at = cell.at * 2 + corner_step(c)};
    if (inside(child.at, levels_[std::size_t(child.level)].size)) children.push_back(child);
  }
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
    Level& level = levels_[std::size_t(cell.level)];
    level.leaf[level.offset(cell.at)] = 1;
    for (const std::size_t texel : corners(cell)) {
      if (site_[texel] != Site::kLit) continue;
      if (level_[texel] < 0) wanted_.push_back(texel);
      level_[texel] = std::max(level_[texel], std::int8_t(cell.level));
    }
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

std::vector<std::size_t> TexelPyramid::wanted() {
  std::sort(wanted_.begin(), wanted_.end());
  return std::exchange(wanted_, {});
}

std::vector<std::uint8_t> TexelPyramid::lit() const {
  std::vector<std::uint8_t> flags(site_.size());
  std::transform(site_.begin(), site_.end(), flags.begin(), [](Site s) { return std::uint8_t(s != Site::kUnlit); });
  return flags;
}

}  // namespace isolux
