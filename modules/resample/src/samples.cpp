#include "samples.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace isolux {
namespace {

bool is_finite(float x) { return std::isfinite(x); }
bool is_finite(const Vec3f& v) { return (int(is_finite(v.x)) & int(is_finite(v.y)) & int(is_finite(v.z))) != 0; }

/// `values`: `each` a sample.
template <class Value>
void require_finite(const char* what, const std::vector<Value>& values, std::size_t each = 1, const char* hint = "") {
  int all = 1;  // without a branch, so that vectors do it: a sample has a dozen numbers
  for (const Value& value : values) all &= int(is_finite(value));
  if (all != 0) return;
  const auto bad = std::find_if(values.begin(), values.end(), [](const Value& value) { return !is_finite(value); });
  throw InvalidInput(fmt::format("sample {}: its {} is infinite or not a number; it must be finite{}",
                                 std::size_t(bad - values.begin()) / each, what, hint));
}

void require_finite_light(const SampleSet& samples) {
  require_finite("position", samples.sites.positions);
  require_finite("radiance", samples.radiance, std::size_t(samples.channels),
                 "; the scene's radiance, irradiance or emission may be too large for floats");
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
  const bool is_told_apart = !samples.lamps.empty() || !samples.lamps_variance.empty();
  if (is_told_apart && (samples.lamps.size() != samples.radiance.size() || samples.lamps_variance.size() != n)) {
    throw InvalidInput(
        fmt::format("{} samples of {} channels with {} radiances and {} variances of lamps: allowed is "
                    "none, or one of each a sample (and channel)",
                    n, samples.channels, samples.lamps.size(), samples.lamps_variance.size()));
  }
  require_finite_light(samples);
  require_finite("isovalue", sites.isovalues);
  require_finite("normal", sites.normals);
  require_finite("variance", samples.variance);  // the largest float stands for one that nobody knows
}

void require_placed(const SampleSet& samples) {
  const std::size_t n = samples.size();
  if (samples.radiance.size() != n * std::size_t(samples.channels)) {
    throw InvalidInput(fmt::format("{} positions of {} channels with {} radiances: one of each is needed", n,
                                   samples.channels, samples.radiance.size()));
  }
  require_finite_light(samples);
}

double relative_noise(const SampleSet& samples) {
  double variance = 0.0;
  std::size_t known = 0;
  for (const float v : samples.variance) {
    if (v >= std::numeric_limits<float>::max()) continue;
    variance += double(v);
    ++known;
  }
  if (known == 0) return std::numeric_limits<double>::infinity();
  double power = 0.0;
  for (const float e : samples.radiance) power += double(e) * double(e);
  if (!(power > 0.0)) return 0.0;
  return variance / double(known) / (power / double(samples.radiance.size()));
}

void require_texels(const Lattice& texels) {
  const Index3& size = texels.size;
  if (size.x < 1 || size.y < 1 || size.z < 1)
    throw InvalidInput(fmt::format("a grid of {}x{}x{} texels: allowed is 1 and more", size.x, size.y, size.z));
  require_spanning(texels.frame, "a grid of texels");
}

}  // namespace isolux
