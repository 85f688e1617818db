#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/random.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "trace_counters.h"
#include "wide/path_waves.h"
#include "wide/site_blocks.h"

namespace isolux {
namespace {

/// Path tracing with many rays at once in the machine's widest vectors, sites sorted by isovalue and place.
class WideTracer final : public FlatTracer {
 public:
  struct Options {
    PathLimits limits;

    void describe(OptionVisitor& option) {
      option("roulette_depth", limits.roulette_depth,
             {.min = 0, .max = 1e6, .help = "reflections before Russian roulette may end a path"});
      option("longest_path", limits.longest_path,
             {.min = 0, .max = 1e6, .help = "reflections at most, for closed pockets of albedo 1"});
    }
  };

  explicit WideTracer(const Options& options) : options_(options) {}

  [[nodiscard]] TraceResult trace(const Volume& volume, const Scene& scene, Sites sites, const TraceSettings& settings,
                                  const Run& run) const override {
    require_usable(sites, settings);
    require_valid(scene);
    TraceResult result;
    SampleSet& samples = result.samples;
    samples.sites = std::move(sites);
    samples.channels = is_grey(scene) ? 1 : 3;
    samples.radiance.resize(samples.size() * std::size_t(samples.channels));
    samples.variance.resize(samples.size());
    light(volume, scene, settings, run, samples, result.counters);
    calibrate_variance(volume, scene, settings, run, samples, result.counters);
    return result;
  }

 private:
  void light(const Volume& volume, const Scene& scene, const TraceSettings& settings, const Run& run,
             SampleSet& samples, TraceCounters& counters) const {
    const wide::PathWaves waves(volume, scene, settings, options_.limits, run.seed);
    const wide::BlockRequest request{.outer = scene.outer,
                                     .rays_per_site = waves.aimer().rays(),
                                     .sites_per_block = waves.aimer().sites_per_batch()};
    std::mutex adding;
    wide::for_each_block(volume, samples.sites, request, run, "trace", [&](const wide::SiteBlock& block) {
      TraceCounters part;
      waves.light(block, samples, part);
      const std::scoped_lock lock(adding);
      add(counters, part);
    });
  }

  // The differences of neighbouring strata say where the variance is, but too much of it: they take the light to be
  // independent where the net makes its errors cancel. How much too much is measured: some sites are lit again with
  // other random numbers, and the differences of the two results are what the variances of those sites must add up to.
  void calibrate_variance(const Volume& volume, const Scene& scene, const TraceSettings& settings, const Run& run,
                          SampleSet& samples, TraceCounters& counters) const {
    constexpr std::size_t kEnough = 512;  // leaves some 5 % of doubt about the factor
    constexpr std::size_t kOneOf = 64;
    const std::size_t step = std::max<std::size_t>(1, std::min(kOneOf, samples.size() / kEnough));
    SampleSet again;
    again.channels = samples.channels;
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < samples.size(); i += step) {
      if (samples.sites.normals[i] == Vec3f(0.0f)) continue;
      numbers.push_back(i);
      again.sites.positions.push_back(samples.sites.positions[i]);
      again.sites.isovalues.push_back(samples.sites.isovalues[i]);
      again.sites.normals.push_back(samples.sites.normals[i]);
    }
    const auto channels = std::size_t(samples.channels);
    again.radiance.resize(again.size() * channels);
    again.variance.resize(again.size());
    Run other = run;
    other.seed = mix_bits(run.seed ^ 0xC0FFEEull);
    other.progress = {};
    light(volume, scene, settings, other, again, counters);
    double expected = 0.0;
    double found = 0.0;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      expected += double(samples.variance[numbers[k]]);
      for (std::size_t c = 0; c < channels; ++c) {
        const double d = double(samples.radiance[numbers[k] * channels + c]) - double(again.radiance[k * channels + c]);
        found += 0.5 * d * d / double(channels);
      }
    }
    if (settings.rays < 2 || !(expected > 0.0)) return;
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (samples.sites.normals[i] != Vec3f(0.0f)) samples.variance[i] *= float(found / expected);
  }

  static void require_usable(const Sites& sites, const TraceSettings& settings) {
    if (sites.isovalues.size() != sites.size() || sites.normals.size() != sites.size()) {
      throw InvalidInput(fmt::format("{} site positions with {} isovalues and {} normals; there must be one of each",
                                     sites.size(), sites.isovalues.size(), sites.normals.size()));
    }
    if (settings.rays < 1) throw InvalidInput(fmt::format("rays = {}: allowed is 1 and more", settings.rays));
    if (settings.bounces < kAllBounces)
      throw InvalidInput(fmt::format("bounces = {}: allowed is -1 (all), 0 and more", settings.bounces));
  }

  Options options_;
};

}  // namespace

namespace backends {
void wide(Registry<FlatTracer>& registry) {
  registry.add<WideTracer>("wide", "path tracing, many rays at once in the machine's widest vectors");
}
}  // namespace backends

}  // namespace isolux
