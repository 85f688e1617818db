#include "shepard.h"

#include <isolux/core/error.h>

#include <array>
#include <cmath>
#include <limits>

#include "samples.h"

namespace isolux {

void ShepardOptions::describe(OptionVisitor& option) {
  option("k", k,
         {.min = -1,
          .max = 1024,
          .help = "nearest samples taken; 0: all within the radius; -1: as many as foretell samples best from each "
                  "other, the more the noisier they are. The thesis: 11"});
  option("exponent", exponent,
         {.min = -1.0,
          .max = 64.0,
          .help = "p of the weight 1/d^p of a sample at distance d; below 0: what foretells samples best from each "
                  "other, the less the noisier they are. The thesis: 0.5"});
  option(
      "distance", distance,
      {{"euclidean", Distance::kEuclidean}, {"city_block", Distance::kCityBlock}, {"chebyshev", Distance::kChebyshev}},
      {.help = "what d is. The thesis: chebyshev"});
  option(
      "radius", radius,
      {.min = 0.0, .unit = "world", .help = "samples beyond are not taken, texels with none are unlit; 0: no limit"});
  option("isovalue_length", isovalue_length,
         {.min = 0.0,
          .max = 1e6,
          .unit = "mean grid spacings",
          .help = "length that the whole range of values counts as in d; 0: d is in space alone"});
}

ShepardSpace::ShepardSpace(const Volume& volume, const SampleSet& samples, const ShepardOptions& options) {
  require_samples(samples);
  if (samples.size() >= std::numeric_limits<std::uint32_t>::max()) {
    throw InvalidInput("too many samples for Shepard's interpolation: fewer than 2^32 - 1 are allowed");
  }
  if (options.k == 0 && options.radius == 0.0) {
    throw InvalidInput("Shepard's k = 0 and radius = 0: one of them must limit the samples of a texel");
  }
  const Vec3 spacing = volume.lattice().frame.spacing();
  const double mean = std::cbrt(spacing.x * spacing.y * spacing.z);
  scale_ = spacing / mean;
  const ValueRange range = value_range(volume);
  const double breadth = double(range.high) - double(range.low);
  if (breadth > 0.0) isovalue_scale_ = options.isovalue_length / breadth;
  for (int a = 0; a < 3; ++a) far_corner_.x[a] = float(scale_[a] * (volume.lattice().size[a] - 1));

  if (options.k > 0) limits_.count = std::size_t(options.k);
  if (options.radius > 0.0) {
    limits_.reach = with_metric(options.distance,
                                [&](auto metric) { return decltype(metric)::axis(float(options.radius / mean)); });
  }
  samples_.reserve(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s) {
    samples_.push_back(point(samples.sites.positions[s], samples.sites.isovalues[s]));
  }
}

Point ShepardSpace::point(const Vec3f& index, float isovalue) const {
  return {{float(scale_.x * double(index.x)), float(scale_.y * double(index.y)), float(scale_.z * double(index.z)),
           float(isovalue_scale_ * double(isovalue))}};
}

ShepardBlend::ShepardBlend(const SampleSet& samples, const ShepardOptions& options)
    : samples_(samples),
      power_(options.exponent * with_metric(options.distance, [](auto metric) { return decltype(metric)::kPower; })) {
  const double quarters = 4.0 * power_;
  quarter_powers_ = quarters == std::floor(quarters) && quarters <= 32.0 ? int(quarters) : -1;
}

double ShepardBlend::weight(double reach_ratio) const {
  if (quarter_powers_ < 0) return std::pow(reach_ratio, -power_);
  // Exponents in use are quarters, and two roots and a few products are ten times faster than pow.
  double product = 1.0;
  double factor = reach_ratio;
  int left = quarter_powers_;
  if (left % 4 == 0) {
    left /= 4;
  } else if (left % 2 == 0) {
    factor = std::sqrt(factor);
    left /= 2;
  } else {
    factor = std::sqrt(std::sqrt(factor));
  }
  for (; left > 0; left /= 2) {
    if (left % 2 != 0) product *= factor;
    factor *= factor;
  }
  return 1.0 / product;
}

void ShepardBlend::operator()(std::span<const Neighbour> neighbours, float* texel) const {
  const auto channels = std::size_t(samples_.channels);
  std::array<double, 3> sum{};
  double total = 0.0;
  // Weights relative to the nearest sample's neither overflow nor vanish together.
  const auto nearest = double(neighbours.front().reach());
  for (const Neighbour& n : neighbours) {
    if (nearest == 0.0 && n.reach() > 0.0f) break;
    const double w = nearest == 0.0 ? 1.0 : weight(double(n.reach()) / nearest);
    total += w;
    const float* radiance = &samples_.radiance[n.sample() * channels];
    for (std::size_t c = 0; c < channels; ++c) sum[c] += w * double(radiance[c]);
  }
  for (std::size_t c = 0; c < channels; ++c) texel[c] = float(sum[c] / total);
}

}  // namespace isolux
