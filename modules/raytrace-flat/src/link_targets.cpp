#include "link_targets.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/random.h>
#include <isolux/core/spread_labels.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

/// Float positions of sites at texel centres are off by less than this up to some 10,000 voxels an axis.
constexpr double kTolerance = 0.01;

}  // namespace

LinkTargets::LinkTargets(const Volume& volume, const Lattice& texels)
    : texels_(texels), to_texel_(index_to_index(volume.lattice(), texels)) {
  if (texels.count() >= kNoLabel)
    throw InvalidInput(fmt::format("{} texels; light links take at most 2^32 - 2", texels.count()));
}

LinkTargets::LinkTargets(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run)
    : LinkTargets(volume, texels) {
  site_of_texel_.assign(texels.count(), kNoLabel);
  for (std::size_t s = 0; s < sites.size(); ++s) {
    if (s % 65536 == 0) throw_if_stopped(run);
    const std::uint32_t texel = texel_at(sites.positions[s]);
    if (texel == kNoLabel || site_of_texel_[texel] != kNoLabel) {
      site_of_texel_ = {};
      return;
    }
    site_of_texel_[texel] = std::uint32_t(s);
  }
  if (sites.size() == 0) site_of_texel_ = {};
  if (sites.size() < site_of_texel_.size()) spread_labels(texels.size, site_of_texel_);
}

std::uint32_t LinkTargets::texel_at(const Vec3f& index) const {
  const Vec3 at = to_texel_.world(Vec3(index));
  int i[3];
  for (int a = 0; a < 3; ++a) {
    const double nearest = std::floor(at[a] + 0.5);
    if (!(std::fabs(at[a] - nearest) <= kTolerance) || nearest < 0.0 || nearest >= double(texels_.size[a]))
      return kNoLabel;
    i[a] = int(nearest);
  }
  return std::uint32_t(texels_.offset(i[0], i[1], i[2]));
}

LinkTargets::Draws LinkTargets::draws_of(std::uint64_t seed, std::size_t site) {
  const std::uint64_t a = mix_bits(mix_bits(seed ^ 0xD1B54A32D192ED03ull) + site);
  const std::uint64_t b = mix_bits(a);
  return {{std::uint32_t(a), std::uint32_t(a >> 32), std::uint32_t(b)}};
}

std::uint32_t LinkTargets::target(const Vec3& index, const Draws& draws, std::uint32_t ray) const {
  // Powers of 1 / 1.2207, the root of x^4 = x + 1, as fractions of 2^32: a lattice of low discrepancy in three
  // dimensions (Roberts 2018), so that rays of a site that end together draw different texels.
  constexpr std::uint32_t kStep[3] = {0xD1B54A33u, 0xABC98388u, 0x8CB92BA7u};
  const Vec3 at = to_texel_.world(index);
  int i[3];
  for (int a = 0; a < 3; ++a) {
    const double x = std::clamp(at[a], 0.0, double(texels_.size[a] - 1));
    i[a] = int(x);
    const double draw = double(draws.start[a] + ray * kStep[a]) * 0x1p-32;
    i[a] += int(draw < x - double(i[a]));
  }
  const std::size_t texel = texels_.offset(i[0], i[1], i[2]);
  return are_sites() ? site_of_texel_[texel] : std::uint32_t(texel);
}

}  // namespace isolux
