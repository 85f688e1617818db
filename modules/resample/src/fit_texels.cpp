#include "fit_texels.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "cell_places.h"
#include "near_field.h"
#include "texel_breadths.h"

namespace isolux {
namespace {

constexpr std::size_t kTexelsABlock = 4096;

/// The texel at corner q of cell (i, j, k).
std::size_t corner_offset(const Lattice& texels, int i, int j, int k, unsigned q) {
  return texels.offset(std::min(i + int(q & 1u), texels.size.x - 1), std::min(j + int(q >> 1 & 1u), texels.size.y - 1),
                       std::min(k + int(q >> 2), texels.size.z - 1));
}

}  // namespace

FitTexels::FitTexels(const Volume& volume, const Lattice& texels, std::span<const std::uint32_t> starts,
                     const FitTerms& terms, const Run& run)
    : texels_(texels), cells_(TexelCells(volume.lattice(), texels).size()), terms_(terms) {
  number(starts);
  measure(volume, run);
}

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
  const ValueRange values = value_range(volume);
  const double range = double(values.high) - double(values.low);
  if (range > 0.0) scale_ = std::exp2(-std::floor(std::log2(range)));
  const double least = range > 0.0 ? 1e-4 * range * scale_ : 1.0;
  const TexelBreadths breadths(volume, texels_);
  const auto nx = std::size_t(texels_.size.x);
  const auto ny = std::size_t(texels_.size.y);
  isovalues_.resize(size());
  inverse_breadths_.assign(size(), 0.0f);
  for (std::vector<float>& normals : normals_)
    if (terms_.normals) normals.resize(size());
  parallel_blocks(size(), kTexelsABlock, run, "", [&](const Block& block) {
    for (std::size_t n = block.begin; n < block.end; ++n) {
      const std::size_t t = offsets_[n];
      const std::size_t j = t / nx % ny;
      const std::size_t k = t / (nx * ny);
      const Vec3 centre = to_volume.world({double(t % nx), double(j), double(k)});
      isovalues_[n] = float(near_field.field().value(centre) * scale_);
      const Vec3 normal = terms_.normals ? near_field.ahead(centre).downhill : Vec3(0.0);
      for (int a = 0; terms_.normals && a < 3; ++a) normals_[std::size_t(a)][n] = float(normal[a]);
      if (terms_.slopes) inverse_breadths_[n] = float(1.0 / std::max(breadths.at(centre) * scale_, least));
    }
  });
}

wide::FitCells FitTexels::cells_along(int j, int k) const {
  wide::FitCells row{.count = std::size_t(cells().x), .texel_count = size()};
  for (unsigned p = 0; p < 4; ++p) row.texels[p] = &number_[corner_offset(texels_, 0, j, k, 2 * p)];
  // Both ends of a used cell's edge are used, so that they are neighbours among the used texels too.
  row.has_pairs = texels_.size.x > 1;
  if (terms_.slopes) row.isovalues = isovalues_.data();
  return row;
}

wide::FitCentres FitTexels::centres() const {
  wide::FitCentres centres{.inverse_breadths = inverse_breadths_.data()};
  for (std::size_t a = 0; terms_.normals && a < 3; ++a) centres.normals[a] = normals_[a].data();
  return centres;
}

void FitTexels::move(std::span<float> numbers, const Run& run) const {
  parallel_blocks(size(), kTexelsABlock, run, "", [&](const Block& block) {
    float* slopes = numbers.data() + size();
    for (std::size_t n = block.begin; terms_.slopes && n < block.end; ++n) slopes[n] *= inverse_breadths_[n];
    for (std::size_t a = 0; terms_.normals && a < 3; ++a) {
      const float* along = numbers.data() + (terms_.first_normal() + a) * size();
      const float* normals = normals_[a].data();
      for (std::size_t n = block.begin; n < block.end; ++n) numbers[n] -= normals[n] * along[n];
    }
  });
}

void FitTexels::move_back(std::span<float> sums, const Run& run) const {
  parallel_blocks(size(), kTexelsABlock, run, "", [&](const Block& block) {
    float* slopes = sums.data() + size();
    for (std::size_t n = block.begin; terms_.slopes && n < block.end; ++n) slopes[n] *= inverse_breadths_[n];
    for (std::size_t a = 0; terms_.normals && a < 3; ++a) {
      float* along = sums.data() + (terms_.first_normal() + a) * size();
      const float* normals = normals_[a].data();
      for (std::size_t n = block.begin; n < block.end; ++n) along[n] -= normals[n] * sums[n];
    }
  });
}

}  // namespace isolux
