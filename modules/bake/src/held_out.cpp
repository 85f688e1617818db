#include "held_out.h"

#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isolux {
namespace {

/// Enough for the error to some 5 %, if there are so many.
constexpr std::size_t kMostHeldOut = 6144;
constexpr std::size_t kTexelsAHeldOut = 8;

}  // namespace

HeldOut::HeldOut(const Volume& volume, const Scene& scene, const Lattice& texels, const TexelSiteMaker& sites,
                 const TraceSettings& settings, const Run& run) {
  draw(texels, sites, run);
  const auto tracer = tracers().create("wide");
  for (std::uint64_t side = 0; side < 2; ++side) {
    Run own = run;
    own.seed = mix_bits(run.seed ^ mix_bits(1 + side));
    TraceResult traced = tracer->trace(volume, scene, sites.make(texels_), settings, own);
    light_[side] = std::move(traced.samples.radiance);
    add(counters_, traced.counters);
  }
}

void HeldOut::draw(const Lattice& texels, const TexelSiteMaker& sites, const Run& run) {
  const std::size_t count = texels.count();
  RandomStream random(run.seed, 0, 0x4e656564);
  // One from each of as many equal shares of the texels, of which those that can be lit stay: all are equally likely.
  const auto from_shares = [&](std::size_t shares) {
    texels_.clear();
    for (std::size_t i = 0; i < shares; ++i) {
      const std::size_t begin = i * count / shares;
      const std::size_t share = (i + 1) * count / shares - begin;
      texels_.push_back(begin + std::min(share - 1, std::size_t(random.uniform_double() * double(share))));
    }
    std::vector<std::uint8_t> lit;
    static_cast<void>(sites.make(texels_, &lit));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < shares; ++i)
      if (lit[i] != 0) texels_[kept++] = texels_[i];
    texels_.resize(kept);
  };
  const std::size_t first = std::min(kMostHeldOut, count);
  from_shares(first);
  const double can_be_lit = double(texels_.size()) / double(first);
  const double wanted = std::min(double(kMostHeldOut), std::ceil(can_be_lit * double(count) / double(kTexelsAHeldOut)));
  if (can_be_lit > 0.0) from_shares(std::min(count, std::size_t(std::ceil(wanted / can_be_lit))));
}

HeldOut::SquaredError HeldOut::squared_error(std::span<const float> light) const {
  if (texels_.empty()) return {};
  const std::size_t channels = light_[0].size() / texels_.size();
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < light_[0].size(); ++i) {
    const auto predicted = double(light[texels_[i / channels] * channels + i % channels]);
    const double product = (double(light_[0][i]) - predicted) * (double(light_[1][i]) - predicted);
    sum += product;
    squares += product * product;
  }
  const auto count = double(light_[0].size());
  const double mean = sum / count;
  // The channels of a texel are taken for one another's copies.
  const double variance = std::max(0.0, squares / count - mean * mean) / double(texels_.size());
  const double standard_error = std::sqrt(variance);
  return {.mean = std::max(standard_error, mean), .standard_error = standard_error};
}

}  // namespace isolux
