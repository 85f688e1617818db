#include "texel_looks.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>

#include "sample_looks.h"

namespace isolux {
namespace {

using wide::LatticeSamples;

constexpr std::array<double, 3> kSteps = {1.0, 2.0, 4.0};  // of the openness, grid spacings
constexpr double kIsovalueLength = 2.0;                    // of the whole range of isovalues, likewise

}  // namespace

TexelLooks::TexelLooks(const Volume& volume, const Sites& sites, const LitTexels& texels)
    : sites_(sites), texels_(texels), near_field_(volume), outwards_(near_field_.outwards(sites)) {
  const ValueRange range = value_range(volume);
  const double breadth = double(range.high) - double(range.low);
  isovalue_scale_ = breadth > 0.0 ? kIsovalueLength / breadth : 0.0;
}

void TexelLooks::write(std::size_t begin, std::size_t end, const Run& run, LatticeSamples& all) const {
  const auto which = std::span(texels_.sites).subspan(begin, end - begin);
  parallel_blocks(which.size(), 512, run, "", [&](const Block& block) {
    const auto here = which.subspan(block.begin, block.end - block.begin);
    const std::size_t first = begin + block.begin;
    SampleLooks looks(near_field_, sites_);
    looks.look(here);
    for (std::size_t t = 0; t < kSteps.size(); ++t) {
      looks.find_openness(outwards_ * kSteps[t]);
      for (std::size_t n = 0; n < here.size(); ++n)
        all.look(first + n)[LatticeSamples::kOpenness + t] = looks.openness(n);
    }
    for (std::size_t n = 0; n < here.size(); ++n) {
      float* const look = all.look(first + n);
      look[LatticeSamples::kIsovalue] = float(isovalue_scale_ * double(sites_.isovalues[here[n]]));
      for (int a = 0; a < 3; ++a) look[LatticeSamples::kNormal + std::size_t(a)] = sites_.normals[here[n]][a];
    }
  });
}

NoisyLight::NoisyLight(const std::vector<float>& radiance, const std::vector<float>& variance, const LitTexels& texels,
                       std::size_t channels, float unit)
    : radiance_(radiance), variance_(variance), texels_(texels), channels_(channels), unit_(unit) {
  if (texels.of_site.empty()) return;
  std::vector<std::uint32_t> counts(texels.sites.size());
  for (const std::uint32_t s : texels.of_site) ++counts[s];
  means_.assign(texels.sites.size() * channels, 0.0f);
  variances_.assign(texels.sites.size(), 0.0f);
  for (std::size_t site = 0; site < texels.of_site.size(); ++site) {
    const std::uint32_t s = texels.of_site[site];
    const float share = 1.0f / float(counts[s]);
    variances_[s] += share * share * (variance[site] * unit * unit);
    for (std::size_t c = 0; c < channels; ++c)
      means_[s * channels + c] += share * (radiance[site * channels + c] * unit);
  }
}

void NoisyLight::write(std::size_t begin, std::size_t end, const Run& run, LatticeSamples& all) const {
  parallel_blocks(end - begin, 4096, run, "", [&](const Block& block) {
    for (std::size_t s = begin + block.begin; s < begin + block.end; ++s) {
      const std::size_t site = texels_.sites[s];
      float* const look = all.look(s);
      look[LatticeSamples::kVariance] = means_.empty() ? variance_[site] * unit_ * unit_ : variances_[s];
      for (std::size_t c = 0; c < channels_; ++c) {
        look[LatticeSamples::kLight + c] =
            means_.empty() ? radiance_[site * channels_ + c] * unit_ : means_[s * channels_ + c];
      }
    }
  });
}

}  // namespace isolux
