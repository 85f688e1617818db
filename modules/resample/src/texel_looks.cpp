#include "texel_looks.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>

#include "near_field.h"
#include "sample_looks.h"

namespace isolux {
namespace {

using wide::LatticeSamples;

constexpr std::array<double, 3> kSteps = {1.0, 2.0, 4.0};  // of the openness, grid spacings
constexpr double kIsovalueLength = 2.0;                    // of the whole range of isovalues, likewise

}  // namespace

void look_at(const Volume& volume, const Sites& sites, std::span<const std::uint32_t> which, const Run& run,
             LatticeSamples& all) {
  all.looks.resize(which.size() * LatticeSamples::stride(all.channels));
  const ValueRange range = value_range(volume);
  const double breadth = double(range.high) - double(range.low);
  const double isovalue_scale = breadth > 0.0 ? kIsovalueLength / breadth : 0.0;
  const NearField near_field(volume);
  const double outwards = near_field.outwards(sites);
  parallel_blocks(which.size(), 512, run, "", [&](const Block& block) {
    const auto here = which.subspan(block.begin, block.end - block.begin);
    SampleLooks looks(near_field, sites);
    looks.look(here);
    for (std::size_t t = 0; t < kSteps.size(); ++t) {
      looks.find_openness(outwards * kSteps[t]);
      for (std::size_t n = 0; n < here.size(); ++n)
        all.look(block.begin + n)[LatticeSamples::kOpenness + t] = looks.openness(n);
    }
    for (std::size_t n = 0; n < here.size(); ++n) {
      float* const look = all.look(block.begin + n);
      look[LatticeSamples::kIsovalue] = float(isovalue_scale * double(sites.isovalues[here[n]]));
      for (int a = 0; a < 3; ++a) look[LatticeSamples::kNormal + std::size_t(a)] = sites.normals[here[n]][a];
    }
  });
}

void take_light(const std::vector<float>& radiance, const std::vector<float>& variance, const LitTexels& texels,
                float unit, LatticeSamples& all) {
  std::vector<std::uint32_t> counts;
  if (texels.of_site.size() > texels.sites.size()) {
    counts.resize(texels.sites.size());
    for (const std::uint32_t s : texels.of_site) ++counts[s];
  }
  for (std::size_t s = 0; s < texels.sites.size(); ++s)
    std::fill_n(all.look(s) + LatticeSamples::kVariance, 1 + all.channels, 0.0f);
  for (std::size_t site = 0; site < texels.of_site.size(); ++site) {
    const std::uint32_t s = texels.of_site[site];
    const float share = counts.empty() ? 1.0f : 1.0f / float(counts[s]);
    float* const look = all.look(s);
    look[LatticeSamples::kVariance] += share * share * (variance[site] * unit * unit);
    for (std::size_t c = 0; c < all.channels; ++c)
      look[LatticeSamples::kLight + c] += share * (radiance[site * all.channels + c] * unit);
  }
}

}  // namespace isolux
