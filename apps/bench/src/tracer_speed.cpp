#include "tracer_speed.h"

#include <isolux/core/stopwatch.h>

#include <algorithm>

namespace isolux::bench {

TracerSpeed tracer_speed(const std::string& tracer, const Volume& volume, const Run& run, double seconds,
                         const SuiteContext& context) {
  const auto sampler = context.stages.samplers.create("random");
  const auto backend = context.stages.tracers.create(tracer);
  const auto sites_of = [&](std::size_t count) {
    return sampler->sample(volume, {.texels = cell_lattice(volume.lattice()), .count = count}, run);
  };
  const auto once = [&](const Sites& sites, TraceCounters& counters) {
    const Stopwatch watch;
    counters = backend->trace(volume, Scene{}, sites, {.rays = kSpeedRays, .bounces = 0}, run).counters;
    return watch.seconds();
  };
  TracerSpeed speed;
  std::size_t count = 512;
  double spent = once(sites_of(count), speed.counters);
  // The first try pays for what a volume costs once: a second one is a better judge.
  for (int step = 0; step < 2; ++step) {
    count = std::min<std::size_t>(grown(count, spent, seconds / (step == 0 ? 30.0 : 6.0)), 4u << 20);
    spent = once(sites_of(count), speed.counters);
  }
  const Sites sites = sites_of(count);
  std::vector<double> rates;
  const Stopwatch all;
  do {
    const double one = once(sites, speed.counters);
    rates.push_back(1e-6 * double(speed.counters.rays) / one);
  } while (rates.size() < 3 || (rates.size() < 9 && all.seconds() < 0.5 * seconds));
  speed.mrays = median(rates);
  return speed;
}

std::size_t grown(std::size_t items, double seconds, double wanted) {
  const double factor = std::clamp(wanted / std::max(seconds, 1e-6), 0.25, 1e4);
  return std::max<std::size_t>(64, std::size_t(double(items) * factor));
}

std::vector<std::string> tracer_names(const SuiteContext& context) {
  std::vector<std::string> names;
  for (const BackendInfo& info : context.stages.tracers.backends()) {
    if (info.unavailable.empty()) names.push_back(info.name);
  }
  return names;
}

std::string default_tracer(const SuiteContext& context) { return context.stages.tracers.info({}).name; }

}  // namespace isolux::bench
