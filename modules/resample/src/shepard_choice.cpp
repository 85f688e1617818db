#include "shepard_choice.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>

#include "sample_bins.h"

namespace isolux {
namespace {

constexpr std::size_t kTried = 1024;  // samples foretold: their mean square error is known to some 5 percent
/// Too few samples to tell: the best of noise-free ones on smooth light (docs/resampling.md, "Shepard's
/// interpolation").
constexpr std::size_t kLeast = 64;
constexpr int kUsualCount = 11;
constexpr double kUsualExponent = 2.0;

constexpr std::array<int, 5> kCounts = {8, 11, 16, 32, 64};
constexpr std::array<double, 5> kExponents = {0.0, 0.5, 1.0, 2.0, 3.0};

struct Candidate {
  std::size_t count;
  double exponent;
  ShepardBlend blend;
};

std::vector<Candidate> candidates_for(const ShepardOptions& options, const SampleSet& samples) {
  std::vector<int> counts(kCounts.begin(), kCounts.end());
  std::vector<double> exponents(kExponents.begin(), kExponents.end());
  if (options.k != ShepardOptions::kFromSamples) counts = {options.k};
  if (options.exponent >= 0.0) exponents = {options.exponent};
  std::vector<Candidate> candidates;
  for (const int count : counts)
    for (const double exponent : exponents) {
      ShepardOptions tried = options;
      tried.exponent = exponent;
      candidates.push_back({std::size_t(count), exponent, ShepardBlend(samples, tried)});
    }
  return candidates;
}

/// Summed squares by candidate of what the others say of one sample less what it is.
void add_errors(const SampleSet& samples, std::size_t sample, std::span<const Neighbour> others,
                std::span<const Candidate> candidates, std::vector<double>& sums) {
  const auto channels = std::size_t(samples.channels);
  std::array<float, 3> foretold{};
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const std::size_t count = candidates[c].count == 0 ? others.size() : std::min(candidates[c].count, others.size());
    candidates[c].blend(others.first(count), foretold.data());
    for (std::size_t v = 0; v < channels; ++v) {
      const double error = double(foretold[v]) - double(samples.radiance[sample * channels + v]);
      sums[c] += error * error;
    }
  }
}

}  // namespace

ShepardOptions chosen_by_samples(ShepardOptions options, const Volume& volume, const SampleSet& samples,
                                 const Run& run) {
  const bool open = options.k == ShepardOptions::kFromSamples || options.exponent < 0.0;
  if (!open) return options;
  ShepardOptions usual = options;
  if (usual.k == ShepardOptions::kFromSamples) usual.k = kUsualCount;
  if (usual.exponent < 0.0) usual.exponent = kUsualExponent;
  if (samples.size() < kLeast) return usual;

  const std::vector<Candidate> candidates = candidates_for(options, samples);
  ShepardOptions widest = usual;
  for (const Candidate& candidate : candidates)
    if (candidate.count > 0) widest.k = std::max(widest.k, int(candidate.count) + 1);  // the sample finds itself too
  const ShepardSpace space(volume, samples, widest);
  const SampleBins bins(space.samples(), space.far_corner(), 1.0);
  const std::size_t tried = std::min(kTried, samples.size());
  std::vector<std::vector<double>> sums(block_count(tried, 64), std::vector<double>(candidates.size(), 0.0));
  parallel_blocks(tried, 64, run, "", [&](const Block& block) {
    std::vector<Neighbour> found;
    for (std::size_t n = block.begin; n < block.end; ++n) {
      const std::size_t sample = n * samples.size() / tried;
      with_metric(options.distance,
                  [&](auto metric) { bins.search<decltype(metric)>(space.samples()[sample], space.limits(), found); });
      std::erase_if(found, [&](const Neighbour& other) { return other.sample() == sample; });
      if (!found.empty()) add_errors(samples, sample, found, candidates, sums[block.index]);
    }
  });
  for (std::size_t b = 1; b < sums.size(); ++b)
    for (std::size_t c = 0; c < candidates.size(); ++c) sums[0][c] += sums[b][c];
  const auto best = std::size_t(std::min_element(sums[0].begin(), sums[0].end()) - sums[0].begin());
  if (sums[0][best] == 0.0) return usual;
  usual.k = int(candidates[best].count);
  usual.exponent = candidates[best].exponent;
  return usual;
}

}  // namespace isolux
