#include "sky_by_noise.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "net_cubes.h"
#include "sky_light.h"
#include "wide/net_mean.h"

namespace isolux {
namespace {

/// The sites with a normal by how many rays they get.
std::map<std::uint32_t, std::vector<std::uint32_t>> by_rays(const Sites& sites, std::span<const std::uint32_t> rays) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> result;
  for (std::size_t site = 0; site < rays.size(); ++site)
    if (sites.normals[site] != Vec3f(0.0f)) result[rays[site]].push_back(std::uint32_t(site));
  return result;
}

/// Makes what there is of some sites so large a share.
void scale(std::span<const std::uint32_t> sites, double share, SampleSet& samples) {
  const auto channels = std::size_t(samples.channels);
  for (const std::uint32_t site : sites) {
    for (std::size_t c = 0; c < channels; ++c) samples.radiance[site * channels + c] *= float(share);
    if (samples.variance[site] < kUnknownVariance) samples.variance[site] *= float(share * share);
  }
}

void add_to(std::vector<float>& sum, const std::vector<float>& part) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = std::min(sum[i] + part[i], kUnknownVariance);
}

/// Traces step by step, and says what part of all that is.
class Steps {
 public:
  Steps(const Volume& volume, const Scene& scene, const TraceSettings& settings, const Run& run)
      : volume_(volume), scene_(scene), settings_(settings), run_(run) {}

  void trace(const SkyRays& rays, SampleSet& samples) {
    if (rays.only.empty() || rays.count == 0) return;
    const double all = double(settings_.rays) * double(samples.size());
    const double end = std::min(1.0, done_ + double(rays.count) * double(rays.only.size()) / all);
    add(counters_, add_sky_light(volume_, scene_, settings_, rays, part_of(run_, done_, end), samples));
    done_ = end;
  }
  [[nodiscard]] const TraceCounters& counters() const { return counters_; }

 private:
  const Volume& volume_;
  const Scene& scene_;
  const TraceSettings& settings_;
  const Run& run_;
  double done_ = 0.0;
  TraceCounters counters_;
};

}  // namespace

bool can_spread(const TraceSettings& settings) {
  return settings.spread == RaySpread::kByNoise && settings.nets == RayNets::kInterleaved && settings.bounces == 0 &&
         settings.rays >= NetCubes::kFirst * NetCubes::kFirst;
}

TraceCounters add_sky_light_by_noise(const Volume& volume, const Scene& scene, const TraceSettings& settings,
                                     const Run& run, SampleSet& samples, std::vector<std::uint32_t>& rays) {
  const int first = settings.rays / NetCubes::kFirst;
  NetCubes cubes(samples.sites);
  const auto [some, others] = cubes.parts();
  SampleSet sky{.sites = {}, .channels = samples.channels, .radiance = {}, .variance = {}};
  std::swap(sky.sites, samples.sites);
  wide::put_darkness(sky, std::size_t(settings.rays));
  Steps steps(volume, scene, settings, run);
  steps.trace({.count = first, .all = settings.rays, .only = some}, sky);
  cubes.learn(some, sky.variance);
  if (!cubes.pays(settings.rays)) {
    std::swap(sky.sites, samples.sites);
    TraceCounters counters = add_sky_light(volume, scene, settings, {.count = settings.rays}, run, samples);
    add(counters, steps.counters());
    return counters;
  }
  steps.trace({.count = first, .all = settings.rays, .only = others}, sky);
  cubes.learn(others, sky.variance);
  rays = cubes.spread(settings.rays);
  for (const auto& [count, sites] : by_rays(sky.sites, rays)) {
    const auto own = int(count);
    const bool goes_on = own <= settings.rays;
    const int begin = goes_on ? first : 0;
    scale(sites, double(begin) / double(own), sky);
    steps.trace({.first = begin,
                 .count = own - begin,
                 .all = goes_on ? settings.rays : own,
                 .share = double(own - begin) / double(own),
                 .only = sites},
                sky);
  }
  std::swap(sky.sites, samples.sites);
  add_to(samples.radiance, sky.radiance);
  add_to(samples.variance, sky.variance);
  return steps.counters();
}

TraceCounters add_sky_light_of(std::span<const std::uint32_t> rays, const Volume& volume, const Scene& scene,
                               const TraceSettings& settings, const Run& run, SampleSet& samples) {
  TraceCounters counters;
  for (const auto& [count, sites] : by_rays(samples.sites, rays)) {
    const SkyRays own{.count = int(count), .all = int(count), .only = sites};
    add(counters, add_sky_light(volume, scene, settings, own, run, samples));
  }
  return counters;
}

}  // namespace isolux
