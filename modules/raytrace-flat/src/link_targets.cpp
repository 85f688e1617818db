#include "link_targets.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

/// Float positions of sites at texel centres are off by less than this up to some 10,000 voxels an axis.
constexpr double kTolerance = 0.01;

}  // namespace

LinkTargets::LinkTargets(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run)
    : texels_(texels), to_texel_(index_to_index(volume.lattice(), texels)) {
  if (texels.count() >= kNone)
    throw InvalidInput(fmt::format("{} texels; light links take at most 2^32 - 2", texels.count()));
  site_of_texel_.assign(texels.count(), kNone);
  for (std::size_t s = 0; s < sites.size(); ++s) {
    if (s % 65536 == 0) throw_if_stopped(run);
    const std::uint32_t texel = texel_at(sites.positions[s]);
    if (texel == kNone || site_of_texel_[texel] != kNone) {
      site_of_texel_ = {};
      return;
    }
    site_of_texel_[texel] = std::uint32_t(s);
  }
  if (sites.size() == 0) site_of_texel_ = {};
  if (sites.size() < site_of_texel_.size()) fill_unlit();
}

std::uint32_t LinkTargets::texel_at(const Vec3f& index) const {
  const Vec3 at = to_texel_.world(Vec3(index));
  int i[3];
  for (int a = 0; a < 3; ++a) {
    const double nearest = std::floor(at[a] + 0.5);
    if (!(std::fabs(at[a] - nearest) <= kTolerance) || nearest < 0.0 || nearest >= double(texels_.size[a]))
      return kNone;
    i[a] = int(nearest);
  }
  return std::uint32_t(texels_.offset(i[0], i[1], i[2]));
}

void LinkTargets::fill_unlit() {
  // The front of texels whose site is known, breadth first.
  std::vector<std::uint32_t> front;
  for (std::size_t t = 0; t < site_of_texel_.size(); ++t)
    if (site_of_texel_[t] != kNone) front.push_back(std::uint32_t(t));
  const std::size_t size[3] = {std::size_t(texels_.size.x), std::size_t(texels_.size.y), std::size_t(texels_.size.z)};
  std::vector<std::uint32_t> next;
  while (!front.empty()) {
    next.clear();
    for (const std::uint32_t texel : front) {
      std::size_t stride = 1;
      for (const std::size_t n : size) {
        const std::size_t place = texel / stride % n;
        const auto reach = [&](std::size_t neighbour) {
          if (site_of_texel_[neighbour] != kNone) return;
          site_of_texel_[neighbour] = site_of_texel_[texel];
          next.push_back(std::uint32_t(neighbour));
        };
        if (place > 0) reach(texel - stride);
        if (place + 1 < n) reach(texel + stride);
        stride *= n;
      }
    }
    front.swap(next);
  }
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
