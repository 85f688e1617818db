#include <isolux/core/parallel.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "morton.h"
#include "path_tracer.h"
#include "trace_request.h"
#include "wide/net_mean.h"

namespace isolux {
namespace {

constexpr std::size_t kSitesABlock = 32;

/// One path of a site: the stratum of its first direction, by morton_place(), and what it brought.
struct PathValue {
  std::uint64_t stratum = 0;
  Vec3 radiance{0.0};
};

// Squared standard error of the mean, mean over the channels. Plain variance / n would count the differences between
// far directions, which stratification has removed; differences of neighbours in the order of the strata keep what is
// left (collapsed strata, Cochran, "Sampling techniques", 1977; successive differences, von Neumann 1941).
double variance_of_mean(std::vector<PathValue>& paths, int channels) {
  if (paths.size() < 2) return std::numeric_limits<float>::max();
  std::sort(paths.begin(), paths.end(), [](const PathValue& a, const PathValue& b) { return a.stratum < b.stratum; });
  double sum = 0.0;
  for (std::size_t i = 1; i < paths.size(); ++i) {
    for (int c = 0; c < channels; ++c) {
      const double difference = paths[i].radiance[c] - paths[i - 1].radiance[c];
      sum += difference * difference;
    }
  }
  const auto n = double(paths.size());
  return sum / (2.0 * (n - 1.0) * n * channels);
}

/// Path tracing in double precision, one ray at a time: the oracle of the faster backends.
class ScalarTracer final : public FlatTracer {
 public:
  using Options = PathOptions;

  explicit ScalarTracer(const Options& options) : options_(options) {}

  [[nodiscard]] TraceResult trace(const Volume& volume, const Scene& scene, Sites sites, const TraceSettings& settings,
                                  const Run& run) const override {
    require_usable(sites, settings);
    require_valid(scene);
    TraceResult result;
    SampleSet& samples = result.samples;
    samples.sites = std::move(sites);
    samples.channels = is_grey(scene) ? 1 : 3;
    const PathTracer tracer(volume, scene, settings, options_.limits);
    // Differences of neighbouring strata are too large still, as those of `wide`.
    wide::light_and_calibrate(samples, run, [&](SampleSet& some, const Run& own, SiteRays&) {
      light(tracer, settings.rays, own, some, result.counters);
    });
    return result;
  }

 private:
  static void light(const PathTracer& tracer, int rays, const Run& run, SampleSet& samples, TraceCounters& counters) {
    samples.radiance.resize(samples.size() * std::size_t(samples.channels));
    samples.variance.resize(samples.size());
    std::vector<TraceCounters> parts(block_count(samples.size(), kSitesABlock));
    parallel_blocks(samples.size(), kSitesABlock, run, "trace", [&](const Block& block) {
      for (std::size_t i = block.begin; i < block.end; ++i)
        light_site(tracer, rays, PathSampler(run.seed, i), i, samples, parts[block.index]);
    });
    for (const TraceCounters& part : parts) add(counters, part);
  }

  // A site without a normal has no light: e = 0, and the variance says that nothing is known.
  static void light_site(const PathTracer& tracer, int rays, const PathSampler& numbers, std::size_t site,
                         SampleSet& samples, TraceCounters& counters) {
    const Sites& sites = samples.sites;
    std::vector<PathValue> paths;
    if (sites.normals[site] != Vec3f(0.0f)) paths.resize(std::size_t(rays));
    Vec3 sum(0.0);
    for (std::size_t path = 0; path < paths.size(); ++path) {
      UnitPair first{};
      paths[path].radiance = tracer.radiance(Vec3(sites.positions[site]), Vec3(sites.normals[site]),
                                             sites.isovalues[site], numbers, std::uint32_t(path), first, counters);
      paths[path].stratum = morton_place(std::uint32_t(first.u * 0x1p32), std::uint32_t(first.v * 0x1p32));
      sum += paths[path].radiance;
    }
    if (!paths.empty()) sum /= double(paths.size());
    for (int c = 0; c < samples.channels; ++c)
      samples.radiance[site * std::size_t(samples.channels) + std::size_t(c)] = float(sum[c]);
    samples.variance[site] =
        float(std::min(variance_of_mean(paths, samples.channels), double(std::numeric_limits<float>::max())));
  }

  Options options_;
};

}  // namespace

namespace backends {
void scalar(Registry<FlatTracer>& registry) {
  registry.add<ScalarTracer>("scalar", "path tracing in double precision, one ray at a time; the reference");
}
}  // namespace backends

}  // namespace isolux
