#include <fmt/format.h>
#include <hwy/cache_control.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/raytrace_flat/light_links.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "link_solver.h"
#include "prefetch_sites.h"
#include "ray_values.h"
#include "wide/aimer.h"
#include "wide/net_mean.h"

namespace isolux {
namespace {

void prefetch(const SampleSet& samples, std::size_t site) {
  hwy::Prefetch(&samples.radiance[site * std::size_t(samples.channels)]);
  hwy::Prefetch(&samples.variance[site]);
}

}  // namespace

LightLinks::LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run)
    : LightLinks(volume, std::move(sites), settings, run, WithoutProbes{}) {
  const Lattice texels = settings.texels.value_or(cell_lattice(volume.lattice()));
  if (settings.ends == LinkEnds::kKept)
    rounds_->targets = std::make_shared<const LinkTargets>(volume, sites_, texels, run);
  if (settings.ends == LinkEnds::kAtTexels)
    rounds_->targets = std::make_shared<const LinkTargets>(volume, texels, LinkTargets::Weights::kByIsovalue, run);
  trace(0, std::size_t(settings.rays), {}, run);
  probes_ = wide::choose_probes(sites_);
  Run other = run;
  other.seed = wide::probe_seed(run.seed);
  other.progress = {};
  again_.reset(new LightLinks(volume, wide::sites_of(sites_, probes_), settings, other, WithoutProbes{}));
  again_->rounds_->targets = rounds_->targets;
  again_->trace(0, std::size_t(settings.rays), {}, other);
  add(counters_, again_->counters_);
}

LightLinks::LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run, WithoutProbes)
    : volume_(volume),
      sites_(std::move(sites)),
      settings_(settings),
      seed_(run.seed),
      rays_(sites_.size(), std::uint32_t(std::max(0, settings.rays))),
      rounds_(std::make_unique<Rounds>()) {
  if (settings.rays < 1) throw InvalidInput(fmt::format("rays = {}: allowed is 1 and more", settings.rays));
}

LightLinks::~LightLinks() = default;

void LightLinks::trace(std::size_t first, std::size_t rays, std::span<const std::uint32_t> numbers, const Run& run) {
  Run own = run;
  own.seed = seed_;
  const auto question = settings_.ends == LinkEnds::kDropped ? RayQuestion::kAnyHit : RayQuestion::kFirstHit;
  const RoundRequest request{
      .first = first, .rays = rays, .outer = settings_.outer, .question = question, .nets = settings_.nets};
  rounds_->all.push_back(trace_round(volume_, sites_, numbers, rounds_->targets.get(), request, own, counters_));
}

void LightLinks::extend(std::span<const std::uint32_t> sites, const Run& run) {
  if (settings_.nets == RayNets::kInterleaved) throw InvalidInput("links of interleaved nets take no more rays");
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_rays;
  for (const std::uint32_t site : sites) by_rays[rays_[site]].push_back(site);
  for (const auto& [rays, numbers] : by_rays) {
    trace(rays, rays, numbers, run);
    for (const std::uint32_t site : numbers) rays_[site] *= 2;
  }
  if (again_ == nullptr) return;
  std::vector<std::uint32_t> doubled;
  for (std::size_t p = 0; p < probes_.size(); ++p)
    if (again_->rays_[p] != rays_[probes_[p]]) doubled.push_back(std::uint32_t(p));
  Run quiet = run;
  quiet.progress = {};
  const TraceCounters before = again_->counters_;
  again_->extend(doubled, quiet);
  add(counters_, again_->counters_ - before);
}

void LightLinks::append(const Sites& more, const Run& run) {
  if (settings_.ends == LinkEnds::kKept)
    throw InvalidInput("links that know the sites at the texels take no more sites");
  if (settings_.nets == RayNets::kInterleaved) throw InvalidInput("links of interleaved nets take no more sites");
  if (more.size() == 0) return;
  std::vector<std::uint32_t> numbers(more.size());
  std::iota(numbers.begin(), numbers.end(), std::uint32_t(sites_.size()));
  sites_.positions.insert(sites_.positions.end(), more.positions.begin(), more.positions.end());
  sites_.isovalues.insert(sites_.isovalues.end(), more.isovalues.begin(), more.isovalues.end());
  sites_.normals.insert(sites_.normals.end(), more.normals.begin(), more.normals.end());
  rays_.resize(sites_.size(), std::uint32_t(settings_.rays));
  trace(0, std::size_t(settings_.rays), numbers, run);
  if (again_ == nullptr) return;
  const std::vector<std::size_t> probes = wide::choose_probes(more);
  for (const std::size_t probe : probes) probes_.push_back(numbers.front() + probe);
  Run quiet = run;
  quiet.progress = {};
  const TraceCounters before = again_->counters_;
  again_->append(wide::sites_of(more, probes), quiet);
  add(counters_, again_->counters_ - before);
}

std::size_t LightLinks::bytes() const {
  std::size_t bytes = again_ == nullptr ? 0 : again_->bytes();
  for (const LinkRound& round : rounds_->all)
    for (const LinkBlock& block : round.blocks) bytes += block.bytes();
  return bytes;
}

SampleSet LightLinks::lamp_light(const Scene& scene, const SolveSettings& settings, TraceCounters& counters,
                                 const Run& run) const {
  SampleSet samples;
  samples.channels = is_grey(scene) ? 1 : 3;
  samples.radiance.resize(sites_.size() * std::size_t(samples.channels));
  samples.variance.resize(sites_.size());
  if (scene.lights.empty()) return samples;
  Scene lamps = scene;
  lamps.environment = UniformEnvironment{Vec3f(0.0f)};
  lamps.emission = {.keys = {{0.0f, Vec3f(0.0f)}}};
  const TraceSettings trace{.rays = settings_.rays, .bounces = 0, .gradient = settings.gradient};
  Run own = run;
  own.seed = seed_;
  TraceResult result = tracers().create("wide")->trace(volume_, lamps, sites_, trace, own);
  add(counters, result.counters);
  for (std::size_t i = 0; i < samples.radiance.size(); ++i)
    samples.radiance[i] = result.samples.radiance[result.samples.channels == samples.channels ? i : i / 3];
  samples.variance = std::move(result.samples.variance);
  return samples;
}

void LightLinks::add_up(const Scene& scene, const SampleSet& lamps, const TargetLight& e,
                        std::span<const std::uint32_t> places, SampleSet& samples, const Run& run) const {
  const auto channels = std::size_t(lamps.channels);
  const RayValues brought(scene, e);
  samples.sites = sites_;
  samples.channels = lamps.channels;
  samples.radiance.assign(lamps.radiance.size(), 0.0f);
  samples.variance.assign(lamps.variance.size(), 0.0f);
  const RayNets nets = brought.wants_directions() ? settings_.nets : RayNets::kIndependent;
  for (const LinkRound& round : rounds_->all) {
    const wide::Aimer aimer(volume_.lattice().frame, seed_, round.rays, round.first, nets, sites_);
    parallel_blocks(round.blocks.size(), kBlocksATask, run, "", [&](const Block& task) {
      RayValues::Scratch scratch(round.rays);
      wide::Batch batch;
      batch.clear(round.rays);
      for (std::size_t b = task.begin; b < task.end; ++b) {
        const LinkBlock& block = round.blocks[b];
        for (std::size_t place = 0; place < block.sites.size(); ++place) {
          if (places.empty() && place + kSitesAhead < block.sites.size()) {
            prefetch(sites_, block.sites[place + kSitesAhead]);
            prefetch(samples, block.sites[place + kSitesAhead]);
          }
          const std::size_t site = block.sites[place];
          if (!places.empty() && places[site] == kLeftOut) continue;
          auto known = brought.known_moments(round, block, place, sites_.isovalues[site]);
          if (!known) {
            // The directions are a function of seed and site: they are made again, not kept.
            batch.rays.count = 0;
            if (brought.wants_directions()) aimer.append(sites_, site, batch.rays, batch.world);
            const auto& world = batch.world.axis;
            known = brought.moments(round, block, place, sites_.isovalues[site],
                                    {world[0].data(), world[1].data(), world[2].data()}, scratch);
          }
          const wide::NetMean::Moments& moments = *known;
          for (std::size_t c = 0; c < channels; ++c) {
            samples.radiance[site * channels + c] += float(moments.sum[int(c)]);
            samples.variance[site] += float(moments.differences[int(c)] / double(channels));
          }
        }
      }
    });
  }
  for (std::size_t site = 0; site < sites_.size(); ++site) {
    const auto n = float(rays_[site]);
    const bool is_lit = sites_.normals[site] != Vec3f(0.0f);
    for (std::size_t c = 0; c < channels; ++c) {
      float& value = samples.radiance[site * channels + c];
      value = is_lit ? value / n + lamps.radiance[site * channels + c] : 0.0f;
    }
    float& variance = samples.variance[site];
    variance = is_lit && n > 1.0f ? variance / (2.0f * (n - 1.0f) * n) + lamps.variance[site]
                                  : std::numeric_limits<float>::max();
  }
}

Solution LightLinks::direct(const Scene& scene, const SolveSettings& settings, const Run& run) const {
  SolveSettings none = settings;
  none.bounces = 0;
  return solve(scene, none, {}, run);
}

SampleSet LightLinks::reflecting(const Scene& scene, std::span<const float> texels, const SolveSettings& settings,
                                 const Run& run) const {
  if (settings_.ends != LinkEnds::kAtTexels) throw InvalidInput("light is given at texels: the links must end there");
  Solution last;
  reflect_last(scene, lamp_light(scene, settings, last.counters, run),
               {.values = texels, .channels = is_grey(scene) ? 1u : 3u}, settings, last, run);
  return std::move(last.samples);
}

void LightLinks::reflect_last(const Scene& scene, const SampleSet& lamps, const TargetLight& light,
                              const SolveSettings& settings, Solution& solution, const Run& run) const {
  add_up(scene, lamps, light, {}, solution.samples, run);
  if (again_ == nullptr) return;
  // The probes see the same light with other rays.
  SampleSet again;
  again_->add_up(scene, again_->lamp_light(scene, settings, solution.counters, run), light, {}, again, run);
  wide::calibrate_variance(solution.samples, probes_, again, rays_);
}

Solution LightLinks::solve(const Scene& scene, const SolveSettings& settings, const ToGrid& to_grid, const Run& run,
                           std::span<const float> start) const {
  require_valid(scene);
  if (scene.outer != settings_.outer) throw InvalidInput("the scene's outer side is not that of the light's links");
  if (settings.bounces < kAllBounces)
    throw InvalidInput(fmt::format("bounces = {}: allowed is -1 (all), 0 and more", settings.bounces));
  if (settings.bounces != 0 && settings_.ends == LinkEnds::kDropped)
    throw InvalidInput(fmt::format("bounces = {}: links whose ends were dropped allow 0", settings.bounces));
  Solution solution;
  const SampleSet lamps = lamp_light(scene, settings, solution.counters, run);
  if (settings.bounces == 0) {
    reflect_last(scene, lamps, {.channels = std::size_t(lamps.channels)}, settings, solution, run);
    return solution;
  }
  const bool some = settings.bounces == kAllBounces && settings.one_of > 1 && !rounds_->targets->are_sites();
  std::vector<std::uint32_t> places;
  if (some) places = Solver::places_of_some(sites_.size(), settings.one_of);
  SampleSet straight;
  add_up(scene, lamps, {.channels = std::size_t(lamps.channels)}, places, straight, run);
  Solver solver(*this, scene, straight, std::move(places), to_grid, run);
  straight = {};  // as large as the solution will be
  reflect_last(scene, lamps, solver.before_last(settings, start, solution), settings, solution, run);
  return solution;
}

}  // namespace isolux
