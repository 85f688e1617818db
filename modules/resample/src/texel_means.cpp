#include <isolux/core/parallel.h>
#include <isolux/resample/texel_means.h>

#include <algorithm>
#include <glm/common.hpp>

namespace isolux {

TexelMeans::TexelMeans(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run)
    : texels_(texels), cells_(glm::max(texels.size - 1, Index3(1))) {
  const IndexToWorld to_texels = index_to_index(volume.lattice(), texels);
  std::vector<std::size_t> cell_of(sites.size());
  std::vector<Place> unsorted(sites.size());
  parallel_blocks(sites.size(), 65536, run, "", [&](const Block& block) {
    for (std::size_t s = block.begin; s < block.end; ++s) {
      const Vec3 at = to_texels.world(Vec3(sites.positions[s]));
      std::size_t cell = 0;
      for (int a = 2; a >= 0; --a) {
        // Beyond the outermost texel centres reading clamps to the edge.
        const double x = std::clamp(at[a], 0.0, double(texels_.size[a] - 1));
        const int low = std::min(int(x), cells_[a] - 1);
        unsorted[s].in_cell[std::size_t(a)] = float(x - low);
        cell = cell * std::size_t(cells_[a]) + std::size_t(low);
      }
      unsorted[s].site = std::uint32_t(s);
      cell_of[s] = cell;
    }
  });
  starts_.assign(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z) + 1, 0);
  for (const std::size_t cell : cell_of) ++starts_[cell + 1];
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  places_.resize(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) places_[next[cell_of[s]]++] = unsorted[s];
}

void TexelMeans::add_cell(std::size_t cell, unsigned corner, std::span<const float> radiance, std::size_t channels,
                          std::array<double, 4>& sums) const {
  for (std::uint32_t p = starts_[cell]; p < starts_[cell + 1]; ++p) {
    const Place& place = places_[p];
    float w = 1.0f;
    for (unsigned a = 0; a < 3; ++a) w *= (corner >> a & 1u) != 0 ? place.in_cell[a] : 1.0f - place.in_cell[a];
    for (std::size_t c = 0; c < channels; ++c) sums[c] += double(w) * double(radiance[place.site * channels + c]);
    sums[3] += double(w);
  }
}

ResampledGrid TexelMeans::of(std::span<const float> radiance, int channels, const Run& run) const {
  const auto stride = std::size_t(channels);
  ResampledGrid result{.grid = IlluminationGrid(texels_, channels),
                       .lit = std::vector<std::uint8_t>(texels_.count(), 0)};
  const auto rows = std::size_t(texels_.size.y) * std::size_t(texels_.size.z);
  parallel_blocks(rows, 16, run, "", [&](const Block& block) {
    for (std::size_t row = block.begin; row < block.end; ++row) {
      for (int i = 0; i < texels_.size.x; ++i) {
        const Index3 texel{i, int(row % std::size_t(texels_.size.y)), int(row / std::size_t(texels_.size.y))};
        std::array<double, 4> sums{};
        for (unsigned q = 0; q < 8; ++q) {
          const Index3 cell = texel - Index3(int(q & 1u), int(q >> 1 & 1u), int(q >> 2));
          if (glm::clamp(cell, Index3(0), cells_ - 1) != cell) continue;
          const auto number =
              (std::size_t(cell.z) * std::size_t(cells_.y) + std::size_t(cell.y)) * std::size_t(cells_.x) +
              std::size_t(cell.x);
          add_cell(number, q, radiance, stride, sums);
        }
        if (!(sums[3] > 0.0)) continue;
        const std::size_t t = texels_.offset(texel.x, texel.y, texel.z);
        result.lit[t] = 1;
        for (std::size_t c = 0; c < stride; ++c) result.grid.values[t * stride + c] = float(sums[c] / sums[3]);
      }
    }
  });
  return result;
}

}  // namespace isolux
