#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/release.h>
#include <isolux/core/stopwatch.h>
#include <isolux/raytrace_flat/light_links.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <variant>

#include "bright_light.h"
#include "bright_parts.h"
#include "link_solver.h"
#include "ray_sums.h"
#include "wide/calibrate_variance.h"
#include "wide/net_mean.h"

namespace isolux {
namespace {

void require_scene_of(OuterSide outer, const Scene& scene) {
  require_valid(scene);
  if (scene.outer != outer) throw InvalidInput("the scene's outer side is not that of the light's links");
}

}  // namespace

LightLinks::LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run)
    : LightLinks(volume, std::move(sites), settings, run, WithoutProbes{}) {
  const Lattice texels = settings.texels.value_or(cell_lattice(volume.lattice()));
  std::shared_ptr<LinkTargets> targets;
  if (settings.ends == LinkEnds::kKept) {
    targets = std::make_shared<LinkTargets>(volume, sites_, texels, run);
    if (settings.parts_pockets) targets->part_pockets(volume, sites_, settings.outer, run);
  }
  if (settings.ends == LinkEnds::kAtTexels)
    targets = std::make_shared<LinkTargets>(volume, texels, LinkTargets::Weights::kByIsovalue, run);
  rounds_->targets = targets;
  trace(0, first_rays(), {}, run);
  probes_ = wide::choose_probes(sites_);
  Run other = run;
  other.seed = wide::probe_seed(run.seed);
  other.progress = {};
  again_.reset(new LightLinks(volume, some_of(sites_, probes_), settings, other, WithoutProbes{}));
  again_->rounds_->targets = rounds_->targets;
  again_->trace(0, first_rays(), {}, other);
  add(counters_, again_->counters_);
  if (targets != nullptr && is_closed()) targets->let_texels_go();
}

LightLinks::LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run, WithoutProbes)
    : volume_(volume),
      sites_(std::move(sites)),
      settings_(settings),
      seed_(run.seed),
      rounds_(std::make_unique<Rounds>()) {
  require_equal_lengths(sites_);
  if (settings.rays < 1) throw InvalidInput(fmt::format("rays = {}: allowed is 1 and more", settings.rays));
  const int kept = settings.kept;
  if (kept < 0 || kept > settings.rays || !std::has_single_bit(unsigned(std::max(kept, 1))))
    throw InvalidInput(fmt::format("kept = {}: allowed are 0 and powers of two up to rays ({})", kept, settings.rays));
  if (kept == settings.rays) settings_.kept = 0;
  if (settings_.kept != 0 && settings.ends == LinkEnds::kDropped)
    throw InvalidInput("rays whose ends are dropped are all kept");
  if (settings.nets == RayNets::kIndependent) rays_.assign(sites_.size(), std::uint32_t(settings.rays));
}

LightLinks::~LightLinks() = default;

void LightLinks::trace(std::size_t first, std::size_t rays, std::span<const std::uint32_t> numbers, const Run& run) {
  Run own = run;
  own.seed = seed_;
  rounds_->all.push_back(
      trace_round(volume_, sites_, numbers, rounds_->targets.get(), request(first, rays), own, counters_));
}

RoundRequest LightLinks::request(std::size_t first, std::size_t rays) const {
  const auto question = settings_.ends == LinkEnds::kDropped ? RayQuestion::kAnyHit : RayQuestion::kFirstHit;
  return {.first = first,
          .rays = rays,
          .all_rays = std::size_t(settings_.rays),
          .outer = settings_.outer,
          .question = question,
          .nets = settings_.nets};
}

std::size_t LightLinks::bytes() const {
  std::size_t bytes = again_ == nullptr ? 0 : again_->bytes();
  for (const LinkRound& round : rounds_->all)
    for (const LinkBlock& block : round.blocks) bytes += block.bytes();
  return bytes;
}

SampleSet LightLinks::lamp_light(const SceneParts& parts, const SolveSettings& settings, TraceCounters& counters,
                                 const Run& run) const {
  const Scene& scene = parts.whole();
  SampleSet samples;
  samples.channels = is_grey(scene) ? 1 : 3;
  if (scene.lights.empty() && parts.bright() == nullptr) return samples;
  const TraceSettings trace{.rays = settings_.rays, .bounces = 0, .gradient = settings.gradient};
  Run own = run;
  own.seed = seed_;
  samples.sites = sites_;
  wide::put_darkness(samples, std::size_t(settings_.rays));
  if (!scene.lights.empty()) {
    const TraceResult found = tracers().create("wide")->trace(volume_, lamps_of(scene), sites_, trace, own);
    add(counters, found.counters);
    const SampleSet& lamps = found.samples;
    for (std::size_t i = 0; i < samples.radiance.size(); ++i)
      samples.radiance[i] = lamps.radiance[lamps.channels == samples.channels ? i : i / 3];
    samples.variance = lamps.variance;
  }
  if (parts.bright() != nullptr)
    add(counters, add_bright_light(volume_, scene.outer, *parts.bright(), trace, own, samples));
  samples.sites = {};
  return samples;
}

RayCounts LightLinks::kept_rays() const {
  if (settings_.kept == 0) return all_rays();
  return {.same = std::uint32_t(settings_.kept)};
}

RayCounts LightLinks::all_rays() const { return {.each = rays_, .same = std::uint32_t(settings_.rays)}; }

bool LightLinks::can_let_places_go() const {
  return is_closed() && rounds_->targets != nullptr && rounds_->targets->are_sites() &&
         std::none_of(sites_.normals.begin(), sites_.normals.end(),
                      [](const Vec3f& normal) { return normal == Vec3f(0.0f); });
}

void LightLinks::let_places_go() {
  release(sites_.positions);
  release(sites_.normals);
}

LinkAim LightLinks::aim() const {
  return {.seed = seed_, .all_rays = std::size_t(settings_.rays), .nets = settings_.nets};
}

SampleSet LightLinks::straight(const Scene& scene, const SampleSet& lamps, std::span<const std::uint32_t> places,
                               const Run& run) const {
  RaySums sums(volume_, sites_, scene, {.channels = std::size_t(lamps.channels)}, aim(), places);
  for (const LinkRound& round : rounds_->all) sums.add(round, run);
  return sums.means(kept_rays(), lamps);
}

Solution LightLinks::direct(const Scene& scene, const SolveSettings& settings, const Run& run) const {
  SolveSettings none = settings;
  none.bounces = 0;
  return solve(scene, none, {}, run);
}

SampleSet LightLinks::reflecting(const Scene& scene, std::span<const float> texels, const SolveSettings& settings,
                                 const Run& run) const {
  if (settings_.ends != LinkEnds::kAtTexels) throw InvalidInput("light is given at texels: the links must end there");
  require_scene_of(settings_.outer, scene);
  const std::size_t channels = is_grey(scene) ? 1 : 3;
  const std::size_t wanted = rounds_->targets->texels().count() * channels;
  if (texels.size() != wanted) {
    throw InvalidInput(fmt::format("{} numbers of light at texels: allowed is one a texel and channel, {} in all",
                                   texels.size(), wanted));
  }
  Solution last;
  const SceneParts parts(scene);
  reflect_last(parts, lamp_light(parts, settings, last.counters, run), {.values = texels, .channels = channels},
               settings, last, run);
  return std::move(last.samples);
}

void LightLinks::reflect_last(const SceneParts& parts, const SampleSet& lamps, const TargetLight& light,
                              const SolveSettings& settings, Solution& solution, const Run& run) const {
  solution.samples = reflected(parts.soft(), lamps, light, solution, run);
  if (settings.lamps == LampLight::kToldApart && !lamps.radiance.empty())
    wide::tell_lamps_apart(solution.samples, lamps);
  if (again_ == nullptr) return;
  // The probes see the same light with other rays.
  Run quiet = run;
  quiet.progress = {};
  const SampleSet others = again_->lamp_light(parts, settings, solution.counters, quiet);
  const SampleSet again = again_->reflected(parts.soft(), others, light, solution, quiet);
  if (rays_.empty())
    wide::calibrate_variance(solution.samples, probes_, again);
  else
    wide::calibrate_variance_of_chosen(solution.samples, probes_, again, rays_, quiet);
}

SampleSet LightLinks::reflected(const Scene& scene, const SampleSet& lamps, const TargetLight& light,
                                Solution& solution, const Run& run) const {
  RaySums sums(volume_, sites_, scene, light, aim());
  for (const LinkRound& round : rounds_->all) sums.add(round, run);
  if (settings_.kept == 0) return sums.means(all_rays(), lamps);
  const Stopwatch watch;
  Run own = run;
  own.seed = seed_;
  const LinkRound round = empty_round(std::size_t(settings_.kept), std::size_t(settings_.rays - settings_.kept));
  const wide::Aimer aimer = sums.aimer(round);
  add(solution.counters, trace_links(volume_, sites_, {}, rounds_->targets.get(), request(round.first, round.rays),
                                     round, own, [&](LinkBlock&& block) { sums.add(round, aimer, block); }));
  solution.trace_seconds += watch.seconds();
  return sums.means(all_rays(), lamps);
}

Solution LightLinks::solve(const Scene& scene, const SolveSettings& settings, const ToGrid& to_grid, const Run& run,
                           std::span<const float> start) const {
  require_scene_of(settings_.outer, scene);
  if (settings.bounces < kAllBounces)
    throw InvalidInput(fmt::format("bounces = {}: allowed is -1 (all), 0 and more", settings.bounces));
  if (settings.bounces != 0 && settings_.ends == LinkEnds::kDropped)
    throw InvalidInput(fmt::format("bounces = {}: links whose ends were dropped allow 0", settings.bounces));
  const bool wants_places = !std::holds_alternative<UniformEnvironment>(scene.environment) || !scene.lights.empty();
  if (wants_places && sites_.positions.empty() && !sites_.isovalues.empty())
    throw InvalidInput("the sites' places were let go: allowed are uniform environments without light sources");
  Solution solution;
  const SceneParts parts(scene);
  const SampleSet lamps = lamp_light(parts, settings, solution.counters, run);
  if (settings.bounces == 0) {
    reflect_last(parts, lamps, {.channels = std::size_t(lamps.channels)}, settings, solution, run);
    return solution;
  }
  const bool some = settings.bounces == kAllBounces && settings.one_of > 1 && !rounds_->targets->are_sites();
  std::vector<std::uint32_t> places;
  if (some) places = Solver::places_of_some(sites_.size(), settings.one_of);
  SampleSet first = straight(parts.soft(), lamps, places, run);
  Solver solver(*this, scene, std::move(first), std::move(places), to_grid, run);
  reflect_last(parts, lamps, solver.before_last(settings, start, solution), settings, solution, run);
  return solution;
}

}  // namespace isolux
