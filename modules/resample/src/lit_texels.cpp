#include "lit_texels.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>

#include <limits>

namespace isolux {

std::size_t texel_of(const Sites& sites, std::size_t site, const std::optional<std::size_t>& found) {
  if (found) return *found;
  const Vec3f& position = sites.positions[site];
  throw InvalidInput(fmt::format(
      "sample {} at index ({}, {}, {}) is not at a texel centre: resampler direct needs a sampler that puts its "
      "sites there, such as texels; any other resampler takes scattered sites",
      site, position.x, position.y, position.z));
}

LitTexels::LitTexels(const Lattice& volume, const Sites& lit, const Lattice& texels, const std::array<int, 3>& axes,
                     const Run& run)
    : of_site(lit.size()) {
  constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
  if (lit.size() >= kNone || texels.count() >= kNone)
    throw InvalidInput("too many samples to denoise: fewer than 2^32 - 1 texels and samples are allowed");
  const IndexToWorld to_texels = index_to_index(volume, texels);
  const auto place = [&](std::size_t texel) {
    const auto nx = std::size_t(texels.size.x);
    const auto ny = std::size_t(texels.size.y);
    const std::array<std::size_t, 3> index{texel % nx, texel / nx % ny, texel / (nx * ny)};
    const auto along = [&](std::size_t a) { return std::size_t(texels.size[axes[a]]); };
    return (index[std::size_t(axes[2])] * along(1) + index[std::size_t(axes[1])]) * along(0) +
           index[std::size_t(axes[0])];
  };
  parallel_blocks(lit.size(), 4096, run, "", [&](const Block& block) {
    for (std::size_t s = block.begin; s < block.end; ++s)
      of_site[s] = std::uint32_t(place(texel_of(lit, s, point_at(texels, to_texels.world(Vec3(lit.positions[s]))))));
  });
  at.assign(texels.count(), kNone);
  for (std::size_t s = lit.size(); s-- > 0;) at[of_site[s]] = std::uint32_t(s);
  const std::size_t layer = std::size_t(texels.size[axes[0]]) * std::size_t(texels.size[axes[1]]);
  for (std::size_t t = 0; t < at.size(); ++t) {
    if (t % layer == 0) layers.push_back(std::uint32_t(sites.size()));
    if (at[t] == kNone) continue;
    sites.push_back(at[t]);
    at[t] = std::uint32_t(sites.size() - 1);
  }
  layers.push_back(std::uint32_t(sites.size()));
  if (sites.size() == of_site.size()) {
    of_site = {};
  } else {
    for (std::uint32_t& texel : of_site) texel = at[texel];
  }
}

}  // namespace isolux
