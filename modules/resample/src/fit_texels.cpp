#include "fit_texels.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "near_field.h"

namespace isolux {
namespace {

/// The texel at corner q of cell (i, j, k).
std::size_t corner_offset(const Lattice& texels, int i, int j, int k, unsigned q) {
  return texels.offset(std::min(i + int(q & 1u), texels.size.x - 1), std::min(j + int(q >> 1 & 1u), texels.size.y - 1),
                       std::min(k + int(q >> 2), texels.size.z - 1));
}

}  // namespace

FitTexels::FitTexels(const Volume& volume, const Lattice& texels, std::span<const std::uint32_t> starts,
                     const FitTerms& terms, const Run& run)
    : texels_(texels), terms_(terms) {
  number(starts);
  measure(volume, run);
}

Index3 FitTexels::cells_of(const Lattice& texels) { return glm::max(texels.size - 1, Index3(1)); }

void FitTexels::number(std::span<const std::uint32_t> starts) {
  constexpr std::uint32_t kUsed = 1;
  number_.assign(texels_.count(), 0);
  const Index3 size = cells();
  std::size_t cell = 0;
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i, ++cell) {
        if (starts[cell] == starts[cell + 1]) continue;
        for (unsigned q = 0; q < 8; ++q) number_[corner_offset(texels_, i, j, k, q)] = kUsed;
      }
    }
  }
  for (std::size_t t = 0; t < number_.size(); ++t) {
    if (number_[t] != kUsed) continue;
    number_[t] = std::uint32_t(offsets_.size());
    offsets_.push_back(t);
  }
}

void FitTexels::measure(const Volume& volume, const Run& run) {
  const NearField near_field(volume);
  const IndexToWorld to_volume = index_to_index(texels_, volume.lattice());
  const ValueRange range = value_range(volume);
  const float least = std::max(1e-4f * (range.high - range.low), 1e-30f);
  const Index3 points = volume.lattice().size;
  const Vec3 reach = glm::abs(to_volume.axes[0]) + glm::abs(to_volume.axes[1]) + glm::abs(to_volume.axes[2]);
  const auto nx = std::size_t(texels_.size.x);
  const auto ny = std::size_t(texels_.size.y);
  isovalues_.resize(size());
  inverse_breadths_.assign(size(), 0.0f);
  if (terms_.normals) normals_.resize(size());
  parallel_blocks(size(), 4096, run, "", [&](const Block& block) {
    for (std::size_t n = block.begin; n < block.end; ++n) {
      const std::size_t t = offsets_[n];
      const std::size_t j = t / nx % ny;
      const std::size_t k = t / (nx * ny);
      const Vec3 centre = to_volume.world({double(t % nx), double(j), double(k)});
      isovalues_[n] = float(near_field.field().value(centre));
      if (terms_.normals) normals_[n] = Vec3f(near_field.ahead(centre).downhill);
      if (!terms_.slopes) continue;
      // The voxels of the cells that the texel's linear tent touches.
      const Index3 low = glm::max(Index3(glm::floor(centre - reach + 1e-6)), Index3(0));
      const Index3 high = glm::min(Index3(glm::ceil(centre + reach - 1e-6)), points - 1);
      float smallest = volume.values(low.x, low.y, low.z);
      float largest = smallest;
      for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y) {
          const auto [a, b] = std::minmax_element(&volume.values(low.x, y, z), &volume.values(high.x, y, z) + 1);
          smallest = std::min(smallest, *a);
          largest = std::max(largest, *b);
        }
      inverse_breadths_[n] = 1.0f / std::max(0.5f * (largest - smallest), least);
    }
  });
}

FitCorners FitTexels::corners(int i, int j, int k) const {
  FitCorners corners{};
  for (unsigned q = 0; q < 8; ++q) {
    const std::uint32_t n = number_[corner_offset(texels_, i, j, k, q)];
    corners.texel[q] = n;
    if (q == 0) corners.reference = isovalues_[n];
    corners.isovalue[q] = isovalues_[n] - corners.reference;
    corners.inverse_breadth[q] = inverse_breadths_[n];
    for (int a = 0; terms_.normals && a < 3; ++a) corners.normal[unsigned(a)][q] = normals_[n][a];
  }
  return corners;
}

}  // namespace isolux
