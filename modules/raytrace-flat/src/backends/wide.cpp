#include <isolux/raytrace_flat/flat_tracer.h>

#include <mutex>
#include <utility>
#include <vector>

#include "sky_light.h"
#include "trace_request.h"
#include "wide/net_mean.h"
#include "wide/path_waves.h"
#include "wide/site_blocks.h"

namespace isolux {
namespace {

/// Path tracing with many rays at once in the machine's widest vectors, sites sorted by isovalue and place.
class WideTracer final : public FlatTracer {
 public:
  using Options = PathOptions;

  explicit WideTracer(const Options& options) : options_(options) {}

  [[nodiscard]] TraceResult trace(const Volume& volume, const Scene& scene, Sites sites, const TraceSettings& settings,
                                  const Run& run) const override {
    require_usable(sites, settings);
    require_valid(scene);
    TraceResult result;
    SampleSet& samples = result.samples;
    samples.sites = std::move(sites);
    light(volume, scene, settings, run, samples, result.counters);
    SampleSet again;
    const std::vector<std::size_t> probes = wide::choose_probes(samples.sites);
    again.sites = wide::sites_of(samples.sites, probes);
    Run other = run;
    other.seed = wide::probe_seed(run.seed);
    other.progress = {};
    light(volume, scene, settings, other, again, result.counters);
    wide::calibrate_variance(samples, probes, again);
    return result;
  }

 private:
  void light(const Volume& volume, const Scene& scene, const TraceSettings& settings, const Run& run,
             SampleSet& samples, TraceCounters& counters) const {
    samples.channels = is_grey(scene) ? 1 : 3;
    samples.radiance.resize(samples.size() * std::size_t(samples.channels));
    samples.variance.resize(samples.size());
    if (is_sky_light(scene, settings)) {
      add(counters, add_sky_light(volume, scene, settings, run, samples));
      return;
    }
    const wide::PathWaves waves(volume, scene, settings, options_.limits, run.seed, samples.sites);
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

  Options options_;
};

}  // namespace

namespace backends {
void wide(Registry<FlatTracer>& registry) {
  registry.add<WideTracer>("wide", "path tracing, many rays at once in the machine's widest vectors");
}
}  // namespace backends

}  // namespace isolux
