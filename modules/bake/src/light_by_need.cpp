#include "light_by_need.h"

#include <isolux/core/error.h>
#include <isolux/core/random.h>
#include <isolux/core/stopwatch.h>
#include <isolux/raytrace_flat/light_links.h>
#include <isolux/resample/fill_unlit.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "bake_parts.h"
#include "texel_places.h"
#include "texel_pyramid.h"

namespace isolux {
namespace {

constexpr int kFirstRaysByNeed = 16;
constexpr double kMostRaysATexel = 0x1p18;
constexpr int kMostRoundsByNeed = 16;
/// Texels held out: enough for the error to some 5 %, if there are so many.
constexpr std::size_t kHeldOut = 6144;
constexpr std::size_t kTexelsAHeldOut = 8;
/// Variances of nets fall as rays^-1.5 where light has edges.
constexpr double kDoubling = 0.354;
/// Rough light that is interpolated: a third of its difference from its surroundings if smooth, all of it at edges.
constexpr double kInterpolated = 0.33;
/// What is left of a rough difference at half the distance, squared: between smooth light (1/16) and edges (1/2).
constexpr double kHalved = 0.2;
/// The mean over the surroundings has noise of its own.
constexpr double kNoiseLeft = 0.07;

/// Mean squared error of a cell's texels, by the figures of the cell.
double squared_error(const CellFigures& figures, int level) {
  const bool traced = level + 1 == TexelPyramid::kLevels;
  return figures.kept() * figures.noise + kNoiseLeft * figures.noise +
         (traced ? 0.0 : kInterpolated * figures.roughness);
}

/// What could be done about a cell.
struct Step {
  TexelPyramid::Cell cell;
  bool refines = false;
  double gain = 0.0;  ///< of squared error, over the cell's texels
  double rays = 0.0;
};

Step best_step(const TexelPyramid& pyramid, const TexelPyramid::Cell& cell, const CellFigures& figures) {
  const double before = squared_error(figures, cell.level);
  const auto texels = double(pyramid.texels_of(cell));
  CellFigures more = figures;
  more.noise *= kDoubling;
  Step best{.cell = cell, .gain = texels * (before - squared_error(more, cell.level)), .rays = figures.rays};
  if (figures.rays >= kMostRaysATexel) best.gain = 0.0;
  if (cell.level + 1 < TexelPyramid::kLevels) {
    CellFigures finer = figures;
    finer.roughness *= kHalved;
    const Step step{.cell = cell,
                    .refines = true,
                    .gain = texels * (before - squared_error(finer, cell.level + 1)),
                    .rays = 7.0 * kFirstRaysByNeed};
    if (step.gain * best.rays > best.gain * step.rays) best = step;
  }
  return best;
}

class ByNeed {
 public:
  ByNeed(const Volume& volume, const Scene& scene, const BakeSettings& settings, const Lattice& texels, Sites sites,
         const Run& run)
      : volume_(volume),
        scene_(scene),
        settings_(settings),
        run_(run),
        texels_(texels),
        places_(place(std::move(sites), volume.lattice(), texels)),
        pyramid_(texels, is_grey(scene) ? 1 : 3, places_.has_site) {}

  BakeResult light(BakeResult result) {
    const Stopwatch watch;
    hold_out();
    trace_wanted();
    for (int round = 0;; ++round) {
      pyramid_.update(run_);
      light_ = pyramid_.light(run_);
      squared_error_ = held_out_error();
      if (squared_error_ <= settings_.target_rmse * settings_.target_rmse || round == kMostRoundsByNeed) break;
      if (!take_steps()) break;
      trace_wanted();
    }
    result.seconds["trace"] = watch.seconds();
    finish(result);
    return result;
  }

 private:
  [[nodiscard]] LinkSettings links(int rays) const {
    return {.rays = rays, .outer = scene_.outer, .ends = LinkEnds::kDropped, .texels = texels_};
  }

  [[nodiscard]] Run seeded(std::uint64_t stream) const {
    Run run = run_;
    run.seed = mix_bits(run_.seed ^ mix_bits(stream));
    return run;
  }

  void hold_out() {
    const std::size_t count = places_.texel.size();
    const std::size_t wanted = std::min(kHeldOut, (count + kTexelsAHeldOut - 1) / kTexelsAHeldOut);
    RandomStream random(run_.seed, 0, 0x4e656564);
    // One from each of as many equal shares of the texels.
    for (std::size_t i = 0; i < wanted; ++i) {
      const std::size_t begin = i * count / wanted;
      const std::size_t share = (i + 1) * count / wanted - begin;
      held_out_.push_back(
          places_.texel[begin + std::min(share - 1, std::size_t(random.uniform_double() * double(share)))]);
    }
    const int rays = settings_.target_rmse < 0.012 ? 128 : 32;
    for (std::uint64_t side = 0; side < 2; ++side) {
      const LightLinks traced(volume_, sites_at(places_, held_out_), links(rays), seeded(1 + side));
      held_out_light_[side] = traced.direct(scene_, {}, run_).samples.radiance;
      add(held_out_counters_, traced.counters());
    }
  }

  [[nodiscard]] double held_out_error() const {
    const std::size_t channels = is_grey(scene_) ? 1 : 3;
    double sum = 0.0;
    for (std::size_t i = 0; i < held_out_.size(); ++i) {
      for (std::size_t c = 0; c < channels; ++c) {
        const auto found = double(light_[held_out_[i] * channels + c]);
        sum += (double(held_out_light_[0][i * channels + c]) - found) *
               (double(held_out_light_[1][i * channels + c]) - found);
      }
    }
    return std::max(0.0, sum / std::max(1.0, double(held_out_light_[0].size())));
  }

  void trace_wanted() {
    const std::vector<std::size_t> texels = pyramid_.wanted();
    if (links_ == nullptr) {
      links_ = std::make_unique<LightLinks>(volume_, sites_at(places_, texels), links(kFirstRaysByNeed), run_);
    } else {
      links_->append(sites_at(places_, texels), run_);
    }
    traced_texels_.insert(traced_texels_.end(), texels.begin(), texels.end());
    take_over();
  }

  void take_over() {
    const SampleSet samples = links_->direct(scene_, {}, run_).samples;
    const auto channels = std::size_t(samples.channels);
    TexelPyramid::Traced& traced = pyramid_.traced();
    for (std::size_t i = 0; i < traced_texels_.size(); ++i) {
      const std::size_t texel = traced_texels_[i];
      std::copy_n(&samples.radiance[i * channels], channels, &traced.light[texel * channels]);
      traced.variance[texel] = samples.variance[i];
      traced.rays[texel] = links_->rays()[i];
    }
  }

  /// Steps that gain most for a ray, as many as the target is expected to need. False if none gains anything.
  bool take_steps() {
    std::vector<Step> steps;
    double expected = 0.0;
    pyramid_.for_each_cell([&](const TexelPyramid::Cell& cell, const CellFigures& figures) {
      expected += double(pyramid_.texels_of(cell)) * squared_error(figures, cell.level);
      const Step step = best_step(pyramid_, cell, figures);
      if (step.gain > 0.0) steps.push_back(step);
    });
    std::stable_sort(steps.begin(), steps.end(),
                     [](const Step& a, const Step& b) { return a.gain * b.rays > b.gain * a.rays; });
    // The error found at the texels held out says how far the figures are off.
    const double goal = 0.9 * settings_.target_rmse * settings_.target_rmse / squared_error_;
    std::vector<std::uint8_t> doubled(texels_.count(), 0);
    std::size_t taken = 0;
    double left = expected;
    for (; taken < steps.size() && (left > goal * expected || taken < steps.size() / 50 + 1); ++taken) {
      const Step& step = steps[taken];
      left -= step.gain;
      if (step.refines) {
        pyramid_.refine(step.cell);
        continue;
      }
      for (const std::size_t corner : pyramid_.corners(step.cell)) doubled[corner] = 1;
    }
    std::vector<std::uint32_t> sites;
    for (std::size_t i = 0; i < traced_texels_.size(); ++i)
      if (doubled[traced_texels_[i]] != 0) sites.push_back(std::uint32_t(i));
    links_->extend(sites, run_);
    return taken > 0;
  }

  void finish(BakeResult& result) {
    const Stopwatch watch;
    const auto [least, most] = std::minmax_element(links_->rays().begin(), links_->rays().end());
    if (least != links_->rays().end()) {
      result.least_rays = *least;
      result.most_rays = *most;
    }
    result.link_bytes = links_->bytes();
    add(result.counters, links_->counters());
    const std::size_t traced = traced_texels_.size();
    add(result.counters, held_out_counters_);
    result.skipped["texels_predicted"] = result.sites - traced;
    result.sites = traced;
    result.rmse_estimate = std::sqrt(squared_error_);
    result.light = filled(std::move(light_), is_grey(scene_) ? 1 : 3);
    result.light.detail.isovalues = settings_.isovalues;
    result.unlit_texels = texels_.count() - places_.texel.size();
    if (settings_.wants_error_grid) result.error = filled(errors(), 1);
    result.seconds["resample"] = watch.seconds();
  }

  [[nodiscard]] IlluminationGrid filled(std::vector<float> values, int channels) const {
    ResampledGrid partial{.grid = IlluminationGrid(texels_, channels), .lit = places_.has_site};
    partial.grid.values = std::move(values);
    return fill_unlit(std::move(partial), run_);
  }

  /// The errors that the figures of the cells say, scaled to what was found at the texels held out.
  [[nodiscard]] std::vector<float> errors() const {
    std::vector<float> squared = pyramid_.of_cells([](const TexelPyramid::Cell& cell, const CellFigures& figures) {
      return float(squared_error(figures, cell.level));
    });
    double sum = 0.0;
    for (const std::size_t texel : places_.texel) sum += double(squared[texel]);
    const double scale = sum > 0.0 ? squared_error_ * double(places_.texel.size()) / sum : 0.0;
    for (float& value : squared) value = float(std::sqrt(scale * double(value)));
    return squared;
  }

  const Volume& volume_;
  const Scene& scene_;
  const BakeSettings& settings_;
  const Run& run_;
  Lattice texels_;
  Places places_;
  TexelPyramid pyramid_;
  std::unique_ptr<LightLinks> links_;
  std::vector<std::size_t> traced_texels_;  ///< the links' sites, in their order
  std::vector<std::size_t> held_out_;
  std::array<std::vector<float>, 2> held_out_light_;
  TraceCounters held_out_counters_;
  std::vector<float> light_;
  double squared_error_ = 0.0;
};

/// Empty if it can be.
std::string why_not(const BakeSettings& settings, const Scene& scene) {
  if (!(settings.target_rmse > 0.0)) return "no error is asked for (target_rmse)";
  if (settings.target_seconds > 0.0) return "a time is given; allowed is an error alone";
  if (settings.trace.bounces != 0) return "light is reflected; allowed is bounces = 0";
  if (!scene.lights.empty()) return "the scene has light sources";
  if (std::holds_alternative<ImageEnvironment>(scene.environment)) return "the environment is an image";
  if (settings.tracer.name != "wide") return "the tracer is not wide";
  if (settings.sampler.name != "texels" || settings.resampler.name != "direct") return "sites are not at the texels";
  if (!settings.resampler.settings.empty()) return "the resampler has options of its own";
  return {};
}

}  // namespace

BakeResult bake_by_need(const Volume& volume, const Scene& scene, const BakeSettings& settings, const Stages& stages,
                        const Run& run) {
  const std::string reason = why_not(settings, scene);
  if (!reason.empty()) throw InvalidInput("texels cannot be traced by need: " + reason);
  const Lattice texels = texel_lattice(volume.lattice(), settings);
  BakeResult result;
  Sites sites = sample_sites(volume, scene.outer, settings, texels, stages, run, result);
  return ByNeed(volume, scene, settings, texels, std::move(sites), run).light(std::move(result));
}

}  // namespace isolux
