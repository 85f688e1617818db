#include "tracer_speed.h"

#include <isolux/core/stopwatch.h>
#include <isolux/raytrace_flat/gather.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace isolux::bench {

namespace {

/// Sites as dense as one a cell, on the isovalues nearest to the given one.
class DenseSites {
 public:
  DenseSites(const Volume& volume, float isovalue, const Run& run, const SuiteContext& context)
      : volume_(volume), isovalue_(isovalue), run_(run), sampler_(context.stages.samplers.create("random")) {
    constexpr std::size_t kProbes = 20000;
    const Sites probes = sample(kProbes, {});
    for (const float h : probes.isovalues) distances_.push_back(double(std::fabs(h - isovalue)));
  }
  [[nodiscard]] Sites some(std::size_t count) const {
    const double cells = double(cell_lattice(volume_.lattice()).count());
    if (double(count) >= cells) return sample(std::size_t(cells), {});
    const auto reach = float(quantile(distances_, double(count) / cells));
    return sample(count, ValueRange{.low = isovalue_ - reach, .high = isovalue_ + reach});
  }

 private:
  [[nodiscard]] Sites sample(std::size_t count, std::optional<ValueRange> range) const {
    return sampler_->sample(volume_, {.texels = cell_lattice(volume_.lattice()), .count = count, .isovalues = range},
                            run_);
  }

  const Volume& volume_;
  float isovalue_;
  const Run& run_;
  std::unique_ptr<const SiteSampler> sampler_;
  std::vector<double> distances_;  ///< of random sites' isovalues
};

/// What tracing `sites` counted.
using Trace = std::function<TraceCounters(const Sites& sites)>;

TracerSpeed speed_of(const Trace& trace, const Volume& volume, float isovalue, const Run& run, double seconds,
                     const SuiteContext& context) {
  const DenseSites dense(volume, isovalue, run, context);
  TracerSpeed speed;
  const auto once = [&](const Sites& sites) {
    const Stopwatch watch;
    speed.counters = trace(sites);
    return watch.seconds();
  };
  constexpr std::size_t kFew = 64;
  const Sites few = dense.some(kFew);
  (void)once(few);
  std::vector<double> setups;
  for (int i = 0; i < 3; ++i) setups.push_back(once(few));
  speed.setup_seconds = median(setups).value;
  const auto beyond_setup = [&](const Sites& sites) {
    return std::max(once(sites) - speed.setup_seconds, 0.1 * speed.setup_seconds);
  };
  std::size_t count = 2048;
  for (const double part : {0.05, 0.15}) {
    // Rays have to take about as long as what is subtracted, or its noise is all that is left.
    const double wanted_seconds = std::max(part * seconds, speed.setup_seconds);
    const std::size_t wanted = grown(count, beyond_setup(dense.some(count)), wanted_seconds);
    count = std::clamp<std::size_t>(wanted, count, 4u << 20);
  }
  const Sites sites = dense.some(count);
  std::vector<double> rates;
  const Stopwatch all;
  do {
    const double spent = beyond_setup(sites);
    rates.push_back(1e-6 * double(speed.counters.rays) / spent);
  } while (rates.size() < 3 || (rates.size() < 9 && all.seconds() < 0.5 * seconds));
  speed.mrays = median(rates);
  return speed;
}

}  // namespace

TracerSpeed tracer_speed(const std::string& tracer, const Volume& volume, float isovalue, const Run& run,
                         double seconds, const SuiteContext& context) {
  const auto backend = context.stages.tracers.create(tracer);
  const auto trace = [&](const Sites& sites) {
    return backend->trace(volume, Scene{}, sites, {.rays = kSpeedRays, .bounces = 0}, run).counters;
  };
  return speed_of(trace, volume, isovalue, run, seconds, context);
}

TracerSpeed first_hit_speed(const Volume& volume, float isovalue, const Run& run, double seconds,
                            const SuiteContext& context) {
  const GatherSettings settings{.rays = kSpeedRays, .question = RayQuestion::kFirstHit};
  const auto trace = [&](const Sites& sites) {
    return gather(volume, sites, settings, run, [](const GatheredRays& /*rays*/) {});
  };
  return speed_of(trace, volume, isovalue, run, seconds, context);
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
