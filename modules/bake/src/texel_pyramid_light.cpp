#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/core/spread_labels.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>

#include "grid_index.h"
#include "texel_pyramid.h"

namespace isolux {
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

void TexelPyramid::predict(const Cell& cell, std::vector<float>& light) const {
  const auto at = corners(cell);
  for_each_texel(cell, [&](std::size_t texel, const Vec3& u) {
    if (!is_predicted(texel)) return;
    std::array<double, 3> sum{};
    for (int c = 0; c < 8; ++c) {
      const Index3 s = corner_step(c);
      double w = 1.0;
      for (int a = 0; a < 3; ++a) w *= s[a] != 0 ? u[a] : 1.0 - u[a];
      for (std::size_t k = 0; k < channels_; ++k) sum[k] += w * double(light[at[std::size_t(c)] * channels_ + k]);
    }
    for (std::size_t k = 0; k < channels_; ++k) light[texel * channels_ + k] = float(sum[k]);
  });
}

void TexelPyramid::for_each_predicting(const Run& run, const std::function<void(const Cell&)>& visit) const {
  for (int l = 0; l + 1 < kLevels; ++l) {
    const CellLevel& level = levels_[std::size_t(l)];
    parallel_blocks(level.leaf.size(), kBlock, run, "", [&](const Block& block) {
      for (std::size_t c = block.begin; c < block.end; ++c)
        if (level.leaf[c] != 0) visit({.level = l, .at = level.at(c)});
    });
  }
}

void TexelPyramid::draw_labels(std::span<std::uint32_t> labels, std::uint64_t seed, const Run& run) const {
  for_each_predicting(run, [&](const Cell& cell) {
    const auto at = corners(cell);
    for_each_texel(cell, [&](std::size_t texel, const Vec3& u) {
      if (!is_predicted(texel)) return;
      const std::uint64_t bits = mix_bits(seed ^ mix_bits(texel));
      std::size_t corner = 0;
      for (int a = 0; a < 3; ++a) {
        const double drawn = double(bits >> (21 * a) & 0x1FFFFF) * 0x1p-21;
        corner |= std::size_t(drawn < u[a]) << a;
      }
      labels[texel] = labels[at[corner]];
    });
  });
  if (std::find(labels.begin(), labels.end(), kNoLabel) != labels.end()) spread_labels(texels_.size, labels);
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
  std::vector<float> light(texels_.count() * channels_);
  parallel_blocks(traced_texels_.size(), kBlock, run, "", [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      const std::size_t texel = traced_texels_[i];
      const double taken = is_all_traced_ ? 0.0 : 1.0 - figures_at(texel).kept();
      for (std::size_t c = 0; c < channels_; ++c) {
        const std::size_t v = i * channels_ + c;
        const double off = is_all_traced_ ? 0.0 : taken * double(difference_[v]);
        light[texel * channels_ + c] = std::max(0.0f, float(double(traced_.light[v]) - off));
      }
    }
  });
  for_each_predicting(run, [&](const Cell& cell) { predict(cell, light); });
  return light;
}

}  // namespace isolux
