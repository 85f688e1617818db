#include "wide/net_mean.h"

#include <isolux/core/random.h>

#include <algorithm>
#include <numeric>

#include "morton.h"
#include "wide/calibrate_variance.h"

namespace isolux::wide {
NetMean::NetMean(const SobolPoints& points, std::size_t rays, std::size_t first, double share)
    : order_(rays), share_(share) {
  // Neighbours on the curve share the small squares of the net, and still do after a digital shift.
  std::iota(order_.begin(), order_.end(), 0u);
  const auto place = [&](std::uint32_t ray) { return morton_place(points.u[first + ray], points.v[first + ray]); };
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
}

NetMean::Moments NetMean::moments(std::span<const Vec3> values) const {
  Moments result;
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Vec3& here = values[order_[k]];
    result.sum += here;
    if (k == 0) continue;
    const Vec3 step = here - values[order_[k - 1]];
    result.differences += step * step;
  }
  return result;
}

void NetMean::add(const Moments& moments, std::size_t site, SampleSet& samples) const {
  const auto channels = std::size_t(samples.channels);
  const auto n = double(order_.size());
  double variance = 0.0;
  for (std::size_t c = 0; c < channels; ++c) {
    samples.radiance[site * channels + c] += float(share_ * (moments.sum[int(c)] / n));
    variance += moments.differences[int(c)] / double(channels);
  }
  if (n > 1.0) {
    const double added = share_ * share_ * (variance / (2.0 * (n - 1.0) * n));
    samples.variance[site] = float(std::min(double(samples.variance[site]) + added, double(kUnknownVariance)));
  }
}

void put_darkness(SampleSet& samples, std::size_t rays) {
  samples.radiance.assign(samples.size() * std::size_t(samples.channels), 0.0f);
  samples.variance.resize(samples.size());
  for (std::size_t site = 0; site < samples.size(); ++site)
    samples.variance[site] = rays > 1 && samples.sites.normals[site] != Vec3f(0.0f) ? 0.0f : kUnknownVariance;
}

void tell_lamps_apart(SampleSet& samples, const SampleSet& lamps) {
  samples.lamps = lamps.radiance;
  samples.lamps_variance = lamps.variance;
  for (float& variance : samples.lamps_variance)
    if (variance == kUnknownVariance) variance = 0.0f;
}

std::vector<std::size_t> choose_probes(const Sites& sites) {
  constexpr std::size_t kEnough = 512;  // leaves some 5 % of doubt about the factor
  constexpr std::size_t kOneOf = 64;
  const std::size_t step = std::clamp<std::size_t>(sites.size() / kEnough, 1, kOneOf);
  std::vector<std::size_t> probes;
  // Anywhere in its share: of a grid whose rows are as long as shares all would lie in one plane.
  for (std::size_t share = 0; share < sites.size(); share += step) {
    const std::size_t i = share + std::size_t(mix_bits(share) % std::min(step, sites.size() - share));
    if (sites.normals[i] != Vec3f(0.0f)) probes.push_back(i);
  }
  return probes;
}

std::uint64_t probe_seed(std::uint64_t seed) { return mix_bits(seed ^ 0x9E3779B97F4A7C15ull); }

namespace {

SiteRays of_probes(const SiteRays& rays, std::span<const std::size_t> probes) {
  SiteRays result;
  if (!rays.sky.empty())
    for (const std::size_t probe : probes) result.sky.push_back(rays.sky[probe]);
  for (const SunQuestions& questions : rays.suns) {
    SunQuestions& some = result.suns.emplace_back(SunQuestions{.asked = {}, .rays = questions.rays});
    for (const std::size_t probe : probes) some.asked.push_back(questions.asked[probe]);
  }
  return result;
}

}  // namespace

SiteRays light_and_calibrate(SampleSet& samples, const Run& run, const LightSamples& light) {
  SiteRays rays;
  light(samples, run, rays);
  const std::vector<std::size_t> probes = choose_probes(samples.sites);
  SampleSet again{
      .sites = some_of(samples.sites, probes), .channels = samples.channels, .radiance = {}, .variance = {}};
  Run other = run;
  other.seed = probe_seed(run.seed);
  other.progress = {};
  SiteRays again_rays = of_probes(rays, probes);
  light(again, other, again_rays);
  calibrate_variance(samples, probes, again, rays.sky);
  return rays;
}

}  // namespace isolux::wide
