#include "link_targets.h"

#include <fmt/format.h>
#include <hwy/cache_control.h>
#include <isolux/core/error.h>
#include <isolux/core/field.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/core/spread_labels.h>

#include <algorithm>
#include <atomic>
#include <glm/common.hpp>
#include <optional>

namespace isolux {
namespace {

constexpr std::size_t kEndsAPart = wide::CornerDraws::kMost;
/// What texels in pockets count for those outside, and the other way: next to nothing, where there are others.
constexpr float kAcross = 1e-12f;

}  // namespace

std::vector<float> isovalues_at(const Volume& volume, const Lattice& texels, const Run& run) {
  const TrilinearField field(volume);
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  const auto nx = std::size_t(texels.size.x);
  const auto ny = std::size_t(texels.size.y);
  std::vector<float> isovalues(texels.count());
  parallel_blocks(isovalues.size(), 8192, run, "", [&](const Block& block) {
    for (std::size_t t = block.begin; t < block.end; ++t) {
      const std::size_t j = t / nx % ny;
      const std::size_t k = t / (nx * ny);
      isovalues[t] = float(field.value(to_volume.world({double(t % nx), double(j), double(k)})));
    }
  });
  return isovalues;
}

LinkTargets::LinkTargets(const Volume& volume, const Lattice& texels, Weights weights, const Run& run)
    : texels_(texels), to_texel_(index_to_index(volume.lattice(), texels)) {
  if (texels.count() >= kNoLabel)
    throw InvalidInput(fmt::format("{} texels; light links take at most 2^32 - 2", texels.count()));
  for (int q = 0; q < 8; ++q) {
    const Index3 upper = glm::min(Index3(q & 1, q >> 1 & 1, q >> 2), texels.size - 1);
    corner_[std::size_t(q)] = std::uint32_t(texels.offset(upper.x, upper.y, upper.z));
  }
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) points_.axes[a][b] = float(to_texel_.axes[b][a]);
    points_.origin[a] = float(to_texel_.origin[a]);
    points_.size[a] = std::uint32_t(texels.size[a]);
  }
  if (weights == Weights::kTrilinear) return;
  own_isovalues_ = isovalues_at(volume, texels, run);
  isovalues_ = own_isovalues_;
}

LinkTargets::LinkTargets(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run)
    : LinkTargets(volume, texels, Weights::kTrilinear, run) {
  are_sites_ = sites.size() > 0 && find_sites(sites, run);
  if (!are_sites_) {
    release(site_of_texel_);
    return;
  }
  bool in_order = sites.size() == site_of_texel_.size();
  for (std::size_t t = 0; in_order && t < site_of_texel_.size(); ++t) in_order = site_of_texel_[t] == t;
  if (in_order) {
    release(site_of_texel_);
    isovalues_ = sites.isovalues;
    return;
  }
  spread_labels(texels.size, site_of_texel_);
  own_isovalues_.reserve(site_of_texel_.size());
  for (const std::uint32_t site : site_of_texel_) own_isovalues_.push_back(sites.isovalues[site]);
  isovalues_ = own_isovalues_;
}

void LinkTargets::part_pockets(const Volume& volume, const Sites& sites, OuterSide outer, const Run& run) {
  if (!are_sites_ || volume.lattice().count() >= kNoLabel) return;
  pass_levels_.emplace(volume, outer, run);
  in_pocket_.resize(texels_.count());
  std::atomic<bool> any = false;
  parallel_blocks(in_pocket_.size(), 8192, run, "", [&](const Block& block) {
    bool found = false;
    for (std::size_t t = block.begin; t < block.end; ++t) {
      const std::size_t site = site_of_texel_.empty() ? t : site_of_texel_[t];
      const bool is_in = pass_levels_->is_closed(sites.positions[site], sites.isovalues[site]);
      in_pocket_[t] = is_in ? 1 : 0;
      found |= is_in;
    }
    if (found) any = true;
  });
  if (any) return;
  pass_levels_.reset();
  release(in_pocket_);
}

bool LinkTargets::find_sites(const Sites& sites, const Run& run) {
  site_of_texel_.assign(texels_.count(), kNoLabel);
  for (std::size_t s = 0; s < sites.size(); ++s) {
    if (s % 65536 == 0) throw_if_stopped(run);
    const std::uint32_t texel = texel_at(sites.positions[s]);
    if (texel == kNoLabel || site_of_texel_[texel] != kNoLabel) return false;
    site_of_texel_[texel] = std::uint32_t(s);
  }
  return true;
}

std::uint32_t LinkTargets::texel_at(const Vec3f& index) const {
  const std::optional<std::size_t> texel = point_at(texels_, to_texel_.world(Vec3(index)));
  return texel ? std::uint32_t(*texel) : kNoLabel;
}

LinkTargets::Draws LinkTargets::draws_of(std::uint64_t seed, std::size_t site) {
  const std::uint64_t a = mix_bits(mix_bits(seed ^ 0xD1B54A32D192ED03ull) + site);
  const std::uint64_t b = mix_bits(a);
  return {{std::uint32_t(a), std::uint32_t(a >> 32), std::uint32_t(b)}};
}

void LinkTargets::append_targets(std::span<const End> ends, const Vec3f& from, float isovalue, const Draws& draws,
                                 std::vector<std::uint32_t>& targets) const {
  const bool in_pocket = pass_levels_ && pass_levels_->is_closed(from, isovalue);
  const std::uint32_t own = in_pocket_.empty() ? kNoLabel : texel_at(from);
  // All ends are asked for before the first is looked at: they lie far apart in memory.
  static thread_local std::vector<wide::CornerDraws> parts;
  const auto count_of = [&](std::size_t p) { return std::min(kEndsAPart, ends.size() - p * kEndsAPart); };
  parts.resize((ends.size() + kEndsAPart - 1) / kEndsAPart);
  for (std::size_t p = 0; p < parts.size(); ++p) ask_for(ends.subspan(p * kEndsAPart, count_of(p)), draws, parts[p]);
  const std::size_t before = targets.size();
  targets.resize(before + ends.size());
  for (std::size_t p = 0; p < parts.size(); ++p)
    draw_texels(parts[p], count_of(p), isovalue, in_pocket, &targets[before + p * kEndsAPart]);
  // Where none of the eight is of its kind, a site is.
  for (std::size_t i = before; own != kNoLabel && i < targets.size(); ++i)
    if ((in_pocket_[targets[i]] != 0) != in_pocket) targets[i] = own;
  if (site_of_texel_.empty()) return;
  for (std::size_t i = before; i < targets.size(); ++i) targets[i] = site_of_texel_[targets[i]];
}

void LinkTargets::ask_for(std::span<const End> ends, const Draws& draws, wide::CornerDraws& part) const {
  // Powers of 1 / 1.2207, the root of x^4 = x + 1, as fractions of 2^32: a lattice of low discrepancy in three
  // dimensions (Roberts 2018), so that rays of a site that end together draw different texels.
  constexpr std::uint32_t kStep[3] = {0xD1B54A33u, 0xABC98388u, 0x8CB92BA7u};
  for (int a = 0; a < 3; ++a) {
    for (std::size_t lane = 0; lane < ends.size(); ++lane) {
      part.index[a][lane] = ends[lane].index[a];
      // 24 bits, so that it stays below 1.
      part.uniform[a][lane] = float(std::int32_t((draws.start[a] + ends[lane].ray * kStep[a]) >> 8)) * 0x1p-24f;
    }
  }
  wide::find_corners(part, ends.size(), points_);
  if (isovalues_.empty()) return;
  for (std::size_t lane = 0; lane < ends.size(); ++lane)
    for (std::size_t q = 0; q < 8; q += 2) hwy::Prefetch(&isovalues_[part.lowest[lane] + corner_[q]]);
}

void LinkTargets::draw_texels(wide::CornerDraws& part, std::size_t count, float isovalue, bool in_pocket,
                              std::uint32_t* texels) const {
  const bool by_isovalue = !isovalues_.empty();
  for (std::size_t lane = 0; by_isovalue && lane < count; ++lane) {
    const float* const lowest = &isovalues_[part.lowest[lane]];
    for (std::size_t q = 0; q < 8; ++q) part.away[q][lane] = lowest[corner_[q]] - isovalue;
  }
  const bool by_pocket = !in_pocket_.empty();
  for (std::size_t lane = 0; by_pocket && lane < count; ++lane) {
    const std::uint8_t* const lowest = &in_pocket_[part.lowest[lane]];
    for (std::size_t q = 0; q < 8; ++q)
      part.likeness[q][lane] = (lowest[corner_[q]] != 0) == in_pocket ? 1.0f : kAcross;
  }
  wide::draw_corners(part, count, {.isovalue = by_isovalue, .likeness = by_pocket});
  for (std::size_t lane = 0; lane < count; ++lane) {
    texels[lane] = part.lowest[lane] + corner_[part.corner[lane]];
    if (!site_of_texel_.empty()) hwy::Prefetch(&site_of_texel_[texels[lane]]);
  }
}

}  // namespace isolux
