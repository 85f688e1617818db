#include <fmt/format.h>
#include <isolux/bake/kept_rays.h>
#include <isolux/core/error.h>
#include <isolux/core/release.h>
#include <isolux/core/stopwatch.h>
#include <isolux/resample/fill_unlit.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <utility>
#include <variant>

#include "bake_parts.h"
#include "reading_error.h"
#include "resampling_choice.h"
#include "standard_error.h"
#include "texel_places.h"
#include "texel_rounds.h"

namespace isolux {
namespace {

/// Sites a texel that reflections are iterated over; the others gather the light found.
constexpr double kSitesEnough = 2.0;
/// Rays of a site at a texel whose ends they are iterated over.
constexpr int kEndsEnough = 16;
/// From a larger albedo on it is better that pockets read no light from outside (docs/light.md, "Pockets").
constexpr float kPocketAlbedo = 0.98f;
/// From this one on light that is made in a pocket never ends: without bounds unless some gets out.
constexpr float kEndlessAlbedo = 0.9999f;
/// Sites whose places are made again at once.
constexpr std::size_t kSamplesAPart = std::size_t(1) << 18;

Sites first_of(const Sites& sites, std::size_t count) {
  const auto last = std::ptrdiff_t(std::min(count, sites.size()));
  return {.positions = {sites.positions.begin(), sites.positions.begin() + last},
          .isovalues = {sites.isovalues.begin(), sites.isovalues.begin() + last},
          .normals = {sites.normals.begin(), sites.normals.begin() + last}};
}

/// The fit's texels are few, as they hold more than a mean; reflections are read from means, which do not.
Lattice at_least_one_a_cell(const Lattice& texels, const Lattice& volume) {
  const Index3 cells = volume.size - 1;
  if (glm::all(glm::greaterThanEqual(texels.size, cells))) return texels;
  return cell_lattice(volume, glm::max(texels.size, cells));
}

bool parts_pockets(const Scene& scene) {
  const float albedo = largest_albedo(scene);
  const bool has_near_lamps = std::any_of(scene.lights.begin(), scene.lights.end(),
                                          [](const Light& light) { return !std::holds_alternative<SunLight>(light); });
  return albedo > kPocketAlbedo && (albedo < kEndlessAlbedo || !(has_emission(scene) || has_near_lamps));
}

}  // namespace

KeptRays::KeptRays(const Volume& volume, const Scene& scene, const BakeSettings& given, const Stages& stages,
                   const Run& run)
    : KeptRays(volume, scene, with_defaults(given, volume.lattice(), stages),
               find_sites(volume, scene.outer, with_defaults(given, volume.lattice(), stages), stages, run), stages,
               run) {}

KeptRays::KeptRays(const Volume& volume, const Scene& scene, const BakeSettings& settings, FoundSites found,
                   const Stages& stages, const Run& run)
    : volume_(volume),
      settings_(settings),
      texels_(texel_lattice(volume.lattice(), settings_)),
      reflecting_(reads_means(settings_) ? at_least_one_a_cell(texels_, volume.lattice()) : texels_),
      begun_(std::move(found.begun)) {
  if (scene.sides != LitSides::kOuter)
    throw InvalidInput("rays are kept of one side; a scene that lights both sides is one for bake()");
  resampler_ = stages.resamplers.create(settings_.resampler.name, settings_.resampler.settings);
  const Stopwatch watch;
  require_settings(settings_);
  const int rays = has_target(settings_) ? first_rays(settings_) : settings_.trace.rays;
  const int kept = has_target(settings_) ? rays : kept_rays_a_site(settings_, found.sites.size(), rays);
  if (kept == 0)
    throw InvalidInput(fmt::format("{} sites: even four rays of each take more than the {} bytes that kept rays may",
                                   found.sites.size(), settings_.most_link_bytes));
  if (kept < rays)
    begun_.skipped["links_beyond_memory"] = std::uint64_t(found.sites.size()) * std::uint64_t(rays - kept);
  const LinkSettings request{.rays = rays,
                             .kept = kept < rays ? kept : 0,
                             .outer = scene.outer,
                             .ends = settings_.trace.bounces == 0 ? LinkEnds::kDropped : LinkEnds::kKept,
                             .texels = reflecting_,
                             .parts_pockets = parts_pockets(scene),
                             .nets = has_target(settings_) ? RayNets::kIndependent : RayNets::kInterleaved};
  links_ = std::make_unique<LightLinks>(volume, std::move(found.sites), request, run);
  trace_seconds_ = watch.seconds();
  if (!reads_means(settings_)) {
    if (!has_target(settings_)) ends_one_of_ = std::size_t(std::max(1, kept / kEndsEnough));
    return;
  }
  const double a_texel = settings_.isovalues ? sites_a_texel(volume.lattice(), reflecting_, settings_)
                                             : double(links_->sites().size()) / double(reflecting_.count());
  one_of_ = std::max<std::size_t>(1, std::size_t(a_texel / kSitesEnough * double(kept) / double(rays)));
}

KeptRays::~KeptRays() = default;

IlluminationGrid KeptRays::between_reflections(const SampleSet& samples, const Run& run) {
  if (!reads_means(settings_)) return fill_unlit(resampler_->resample(volume_, samples, texels_, run), run);
  // Samples are always of the same sites: settings_ says how many bounces, hence whether of all or some.
  if (!means_) means_.emplace(volume_, samples.sites, reflecting_, run);
  return fill_unlit(means_->of(samples.radiance, samples.channels, run), run);
}

Solution KeptRays::solve(const Scene& scene, const Run& run, BakeResult& result) {
  const Stopwatch watch;
  const SolveSettings settings{.bounces = settings_.trace.bounces,
                               .gradient = settings_.trace.gradient,
                               .one_of = one_of_,
                               .ends_one_of = ends_one_of_,
                               .lamps = resampler_->lamps()};
  Solution solution = links_->solve(
      scene, settings, [&](const SampleSet& samples) { return between_reflections(samples, run); }, run, last_);
  last_ = solution.samples.radiance;
  trace_seconds_ += solution.trace_seconds;
  result.seconds["bounces"] += watch.seconds() - solution.trace_seconds;
  result.sweeps += solution.sweeps;
  return solution;
}

BakeResult KeptRays::light(const Scene& scene, const Run& run) {
  require_kept();
  BakeResult result = std::exchange(begun_, {});
  SampleSet samples = trace_and_solve(scene, run, result);
  samples.sites = links_->sites();
  finish_bake(volume_, std::move(samples), *resampler_, texels_, settings_, run, result);
  return result;
}

BakeResult KeptRays::last_light(const Scene& scene, const Run& run) && {
  require_kept();
  const BakeSettings judging = settings_to_judge();
  // One ray a site says nothing of its noise, so that there is nothing to set the bias apart from.
  if (settings_.trace.bounces != 0 && (has_target(settings_) || settings_.trace.rays > 1)) {
    const Stopwatch watch;
    judge_ = std::make_unique<const ReadingError>(volume_, scene, links_->sites(), judging, run);
    judge_seconds_ = watch.seconds();
  }
  if (settings_.target_rmse > 0.0 && !are_sites_own(*resampler_, settings_)) {
    const Stopwatch watch;
    texel_rounds_ = std::make_unique<TexelRounds>(
        TexelRounds{.judge = TexelJudge(volume_, scene, judging, links_->sites().size(), run),
                    .target = TexelTarget(settings_.target_rmse)});
    judge_seconds_ += watch.seconds();
  }
  if (can_do_without_places(scene)) {
    const auto places = TexelPlaces::of(volume_.lattice(), texels_, links_->sites().positions);
    if (places) return light_without_places(scene, *places, run);
  }
  BakeResult result = std::exchange(begun_, {});
  SampleSet samples = trace_and_solve(scene, run, result);
  samples.sites = links_->take_sites();
  finish_links();
  if (texel_rounds_ != nullptr && texel_rounds_->is_lit) {
    make_error(volume_, std::move(samples), *resampler_, texels_, settings_, run, result);
    tell_error(texel_rounds_->error, result);
    return result;
  }
  finish_bake(volume_, std::move(samples), *resampler_, texels_, settings_, run, result);
  if (texel_rounds_ != nullptr) {
    tell_error(texel_rounds_->judge.squared_error(result.light, run), result);
    if (result.rmse_estimate <= settings_.target_rmse) result.skipped.erase("rounds_beyond_memory");
  } else if (!are_sites_own(*resampler_, settings_)) {
    judge_texels(volume_, scene, judging, run, result);
  }
  return result;
}

bool KeptRays::can_do_without_places(const Scene& scene) const {
  const bool has_directions = !std::holds_alternative<UniformEnvironment>(scene.environment) || has_lamps(scene);
  return settings_.sampler.name == "texels" && settings_.trace.bounces != 0 && !has_target(settings_) &&
         !settings_.wants_error_grid && !has_directions && resampler_->takes_parts() && links_->can_let_places_go();
}

BakeResult KeptRays::light_without_places(const Scene& scene, const TexelPlaces& places, const Run& run) {
  BakeResult result = std::exchange(begun_, {});
  Sites shown = first_of(links_->sites(), kSamplesShown);
  links_->let_places_go();
  SampleSet samples = trace_and_solve(scene, run, result);
  finish_links();
  result.noise = standard_error(samples.variance);
  result.rmse_estimate = std::hypot(result.noise, result.reading_error);
  const Stopwatch watch;
  IlluminationGrid grid = unlit_grid(texels_, samples.channels);
  const auto channels = std::size_t(samples.channels);
  std::size_t texel = 0;
  std::size_t site = 0;
  while (site < samples.variance.size()) {
    SampleSet part{.sites = {}, .channels = samples.channels, .radiance = {}, .variance = {}};
    part.sites.positions = places.next(texel, kSamplesAPart);
    const auto radiance = samples.radiance.begin() + std::ptrdiff_t(site * channels);
    part.radiance.assign(radiance, radiance + std::ptrdiff_t(part.size() * channels));
    resampler_->add_part(volume_, part, grid, run);
    site += part.size();
  }
  keep_first(kSamplesShown, samples);
  samples.sites = std::move(shown);
  finish_light(volume_, samples, told_by_bytes(std::move(grid)), *resampler_, settings_, run, result);
  result.seconds["resample"] = watch.seconds();
  return result;
}

void KeptRays::require_kept() const {
  if (links_ == nullptr) throw InvalidInput("the rays of last_light() are gone; light() keeps them");
}

void KeptRays::finish_links() {
  links_.reset();
  means_.reset();
  release(last_);
  return_freed_memory();
}

}  // namespace isolux
