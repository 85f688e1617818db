#include <isolux/raytrace_flat/flat_tracer.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "bright_light.h"
#include "bright_parts.h"
#include "sky_by_noise.h"
#include "sky_light.h"
#include "sun_light.h"
#include "trace_request.h"
#include "wide/net_mean.h"
#include "wide/path_waves.h"
#include "wide/trace_blocks.h"

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
    SiteRays found = wide::light_and_calibrate(samples, run, [&](SampleSet& some, const Run& own, SiteRays& rays) {
      std::vector<std::uint32_t> cut;
      light(volume, scene, settings, own, some, rays, cut, result.counters);
      if (&some == &samples) result.cut = std::move(cut);
    });
    result.rays = std::move(found.sky);
    return result;
  }

 private:
  void light(const Volume& volume, const Scene& scene, const TraceSettings& settings, const Run& run,
             SampleSet& samples, SiteRays& rays, std::vector<std::uint32_t>& cut, TraceCounters& counters) const {
    samples.channels = is_grey(scene) ? 1 : 3;
    wide::put_darkness(samples, std::size_t(settings.rays));
    if (settings.bounces == 0)
      without_reflections(volume, scene, settings, run, samples, rays, counters);
    else
      with_reflections(volume, scene, settings, run, samples, cut, counters);
  }

  /// What is seen of the sky, suns and other lamps each by what asks least; their sums and variances add up.
  void without_reflections(const Volume& volume, const Scene& scene, const TraceSettings& settings, const Run& run,
                           SampleSet& samples, SiteRays& rays, TraceCounters& counters) const {
    Scene lamps = scene;
    std::erase_if(lamps.lights, [](const Light& light) { return std::holds_alternative<SunLight>(light); });
    std::vector<std::uint32_t> none_cut;
    if (!lamps.lights.empty()) by_paths(volume, lamps_of(lamps), settings, run, samples, nullptr, none_cut, counters);
    const SceneParts parts(scene);
    if (parts.bright() != nullptr)
      add(counters, add_bright_light(volume, scene.outer, *parts.bright(), settings, run, samples));
    add_suns(volume, scene, settings, run, samples, rays.suns, counters);
    if (tells_apart(scene, settings, parts.bright() != nullptr)) wide::tell_lamps_apart(samples, samples);
    if (!rays.sky.empty())
      add(counters, add_sky_light_of(rays.sky, volume, parts.soft(), settings, run, samples));
    else if (can_spread(settings))
      add(counters, add_sky_light_by_noise(volume, parts.soft(), settings, run, samples, rays.sky));
    else
      add(counters, add_sky_light(volume, parts.soft(), settings, {.count = settings.rays}, run, samples));
  }

  void add_suns(const Volume& volume, const Scene& scene, const TraceSettings& settings, const Run& run,
                SampleSet& samples, std::vector<SunQuestions>& questions, TraceCounters& counters) const {
    std::size_t suns = 0;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
      const auto* const sun = std::get_if<SunLight>(&scene.lights[i]);
      if (sun == nullptr) continue;
      const auto number = std::uint32_t(i);
      if (!can_spread(settings)) {
        add(counters, add_sun_light(volume, scene.outer, *sun, number, settings, run, samples));
        continue;
      }
      if (questions.size() == suns) questions.emplace_back();
      add(counters,
          add_sun_light_by_edges(volume, scene.outer, *sun, number, settings, run, samples, questions[suns++]));
    }
  }

  void with_reflections(const Volume& volume, const Scene& scene, const TraceSettings& settings, const Run& run,
                        SampleSet& samples, std::vector<std::uint32_t>& cut, TraceCounters& counters) const {
    if (!tells_apart(scene, settings, false)) {
      by_paths(volume, scene, settings, run, samples, nullptr, cut, counters);
      return;
    }
    SampleSet lamps{
        .sites = {}, .channels = samples.channels, .radiance = samples.radiance, .variance = samples.variance};
    by_paths(volume, scene, settings, run, samples, &lamps, cut, counters);
    wide::tell_lamps_apart(samples, lamps);
  }

  static bool tells_apart(const Scene& scene, const TraceSettings& settings, bool aims_at_image) {
    return settings.lamps == LampLight::kToldApart && (aims_at_image || !scene.lights.empty());
  }

  void by_paths(const Volume& volume, const Scene& scene, const TraceSettings& settings, const Run& run,
                SampleSet& samples, SampleSet* lamps, std::vector<std::uint32_t>& cut, TraceCounters& counters) const {
    const wide::PathWaves waves(volume, scene, settings, options_.limits, run.seed, samples.sites);
    if (waves.cuts_paths()) cut.assign(samples.size(), 0);
    const wide::BlockRequest request{.outer = scene.outer, .rays_per_site = waves.aimer().rays()};
    add(counters,
        wide::trace_blocks(volume, samples.sites, request, run, [&](const wide::SiteBlock& block, TraceCounters& part) {
          waves.light(block, samples, lamps, cut, part);
        }));
    if (std::all_of(cut.begin(), cut.end(), [](std::uint32_t paths) { return paths == 0; })) cut.clear();
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
