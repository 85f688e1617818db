#include "samples.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

void require_finite(const SampleSet& samples) {
  const auto finite = [](float x) { return std::isfinite(x); };
  if (!std::all_of(samples.radiance.begin(), samples.radiance.end(), finite)) {
    throw InvalidInput("a sample's radiance is infinite or not a number: it must be finite");
  }
}

}  // namespace

void require_samples(const SampleSet& samples) {
  const std::size_t n = samples.size();
  if (n == 0) throw InvalidInput("no samples to resample: at least one is needed");
  if (samples.channels != 1 && samples.channels != 3) {
    throw InvalidInput(fmt::format("samples of {} channels: allowed are 1 and 3", samples.channels));
  }
  const Sites& sites = samples.sites;
  if (sites.isovalues.size() != n || sites.normals.size() != n || samples.variance.size() != n ||
      samples.radiance.size() != n * std::size_t(samples.channels)) {
    throw InvalidInput(fmt::format(
        "{} samples of {} channels with {} isovalues, {} normals, {} radiances and {} variances: one of each a sample "
        "(and channel) is needed",
        n, samples.channels, sites.isovalues.size(), sites.normals.size(), samples.radiance.size(),
        samples.variance.size()));
  }
  require_finite(samples);
}

void require_placed(const SampleSet& samples) {
  const std::size_t n = samples.size();
  if (samples.radiance.size() != n * std::size_t(samples.channels)) {
    throw InvalidInput(fmt::format("{} positions of {} channels with {} radiances: one of each is needed", n,
                                   samples.channels, samples.radiance.size()));
  }
  require_finite(samples);
}

}  // namespace isolux
