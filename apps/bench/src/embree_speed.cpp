#include "embree_speed.h"

#include <isolux/core/stopwatch.h>

#include <algorithm>
#include <vector>

#include "mesh_light.h"
#include "tracer_speed.h"

namespace isolux::bench {

EmbreeSpeed::EmbreeSpeed(const Volume& volume, float isovalue, const SuiteContext& context)
    : mesh_(context.stages.extractors.create()->extract(volume, {.isovalue = isovalue}, context.run)) {
  if (mesh_.n_vertices() > 0) embree_ = EmbreeMesh::build(mesh_);
}

std::pair<Estimate, EmbreeCall> EmbreeSpeed::measured(RayQuestion question, const Run& run, double seconds) const {
  std::pair<Estimate, EmbreeCall> best;
  for (const EmbreeCall call : {EmbreeCall::kPacketsOf8, EmbreeCall::kPacketsOf16, EmbreeCall::kStream}) {
    const Estimate found = of_call(call, question, run, seconds / 3.0);
    if (found.value > best.first.value) best = {found, call};
  }
  return best;
}

Estimate EmbreeSpeed::of_call(EmbreeCall call, RayQuestion question, const Run& run, double seconds) const {
  // Fewer say nothing of a mesh whose parts are differently open.
  const std::size_t least = std::min<std::size_t>(mesh_.n_vertices(), 1024);
  std::size_t vertices = least;
  const auto once = [&] {
    const Stopwatch watch;
    (void)light_vertices(*embree_, call, question, mesh_, vertices, kSpeedRays, run);
    return watch.seconds();
  };
  const double first = once();
  vertices = std::clamp(grown(vertices, first, seconds / 5.0), least, mesh_.n_vertices());
  std::vector<double> rates;
  const Stopwatch all;
  do {
    rates.push_back(1e-6 * double(vertices * kSpeedRays) / once());
  } while (rates.size() < 3 || (rates.size() < 9 && all.seconds() < 0.7 * seconds));
  return median(rates);
}

}  // namespace isolux::bench
