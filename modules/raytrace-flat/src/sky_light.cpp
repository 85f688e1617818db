#include "sky_light.h"

#include <isolux/raytrace_flat/gather.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "environment.h"
#include "link_rounds.h"
#include "prefetch_sites.h"
#include "ray_values.h"
#include "wide/net_mean.h"

namespace isolux {

namespace {

bool is_dark(const Scene& scene) { return !EnvironmentView(scene.environment).shines() && !has_emission(scene); }

}  // namespace

TraceCounters add_sky_light(const Volume& volume, const Scene& scene, const TraceSettings& settings,
                            const SkyRays& asked, const Run& run, SampleSet& samples) {
  if (is_dark(scene)) return {};
  const auto first = std::size_t(asked.first);
  const auto rays = std::size_t(asked.count);
  const wide::NetMean mean(wide::SobolPoints(first + rays), rays, first, asked.share);
  const LinkRound round{.first = first, .rays = rays, .order = mean.order(), .blocks = {}};
  const RayValues brought(scene, {.channels = std::size_t(samples.channels)});
  const GatherSettings request{.rays = asked.count,
                               .outer = scene.outer,
                               .question = RayQuestion::kAnyHit,
                               .all_rays = asked.all,
                               .first_ray = asked.first,
                               .only = asked.only,
                               .nets = settings.nets,
                               .values = settings.values};
  return gather(volume, samples.sites, request, run, [&](const GatheredRays& gathered) {
    static thread_local LinkBlock block;
    RayValues::Scratch scratch(rays);
    block.hits.assign(gathered.sites.size() * round.words(), 0);
    block.begins.assign(gathered.sites.size() + 1, 0);
    for (std::size_t place = 0; place < gathered.sites.size(); ++place) {
      const std::uint32_t site = gathered.sites[place];
      if (place + kSitesAhead < gathered.sites.size()) prefetch_light(samples, gathered.sites[place + kSitesAhead]);
      if (samples.sites.normals[site] == Vec3f(0.0f)) continue;
      const float isovalue = samples.sites.isovalues[site];
      mark_hits(gathered, place, round, block);
      auto moments = brought.known_moments(round, block, place, isovalue);
      if (!moments) {
        std::array<const float*, 3> towards{};
        for (std::size_t a = 0; a < 3; ++a) towards[a] = &gathered.direction[a][place * rays];
        moments = brought.moments(round, block, place, isovalue, towards, scratch);
      }
      mean.add(*moments, site, samples);
    }
  });
}

}  // namespace isolux
