#include "light_by_need.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/core/release.h>
#include <isolux/core/spread_labels.h>
#include <isolux/core/stopwatch.h>
#include <isolux/raytrace_flat/light_links.h>
#include <isolux/resample/fill_unlit.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "bake_parts.h"
#include "held_out.h"
#include "need_steps.h"
#include "ray_budget.h"
#include "standard_error.h"
#include "texel_pyramid.h"
#include "texel_site_maker.h"

namespace isolux {
namespace {

/// Enough for the error to some 5 %, if there are so many.
constexpr std::size_t kMostHeldOut = 6144;
constexpr std::size_t kTexelsAHeldOut = 8;
constexpr int kMostRoundsByNeed = 16;
/// A round that leaves more of the squared error than this has stalled; so many in a row are enough.
constexpr double kProgress = 0.97;
constexpr int kMostStalled = 2;
constexpr std::size_t kTexelsABlock = 16384;
constexpr std::size_t kMostTexels = 0xFFFF0000u;  ///< they are numbered in 32 bits
/// Where more of the texels are traced each, predicting the others is not worth its price.
constexpr double kRough = 0.8;

class ByNeed {
 public:
  ByNeed(const Volume& volume, const Scene& scene, const BakeSettings& settings, const Lattice& texels, const Run& run)
      : volume_(volume),
        scene_(scene),
        settings_(settings),
        run_(run),
        texels_(texels),
        channels_(is_grey(scene) ? 1 : 3),
        sites_(volume, site_request(volume, settings, texels, scene.outer, run), run),
        pyramid_(texels, channels_, [this](std::span<const std::size_t> asked) {
          std::vector<std::uint8_t> lit;
          static_cast<void>(sites_.make(asked, &lit));
          return lit;
        }) {}

  BakeResult light() {
    const Stopwatch watch;
    BakeResult result;
    trace_wanted();
    TraceSettings judged = settings_.trace;
    judged.rays = settings_.target_rmse < 0.012 ? 128 : 32;
    std::vector<std::size_t> drawn = held_out_texels(texels_, sites_, kMostHeldOut, kTexelsAHeldOut, run_);
    const Sites some = sites_.make(drawn);
    const HeldOut held_out(volume_, scene_, some, std::move(drawn), judged, run_);
    int stalled = 0;
    for (int round = 0;; ++round) {
      solve(result);
      HeldOut::SquaredError found = held_out.squared_error(light_);
      found.mean = std::max(found.mean, found.standard_error);  // few texels can agree by chance
      const double before = std::exchange(squared_error_, found.mean);
      // Not by luck: of many rounds one is the first whose figure is low by chance.
      const bool reached = found.mean + found.standard_error <= settings_.target_rmse * settings_.target_rmse;
      if (reached || round == kMostRoundsByNeed) break;
      stalled = round > 0 && squared_error_ > kProgress * before ? stalled + 1 : 0;
      if (stalled == kMostStalled) break;
      if (!take_steps(found)) break;
    }
    result.seconds["trace"] = watch.seconds() - result.seconds["bounces"];
    count_judging(held_out, result);
    finish(result);
    return result;
  }

 private:
  [[nodiscard]] bool reflects() const { return settings_.trace.bounces != 0; }

  [[nodiscard]] LinkSettings links(int rays) const {
    return {.rays = rays,
            .outer = scene_.outer,
            .ends = reflects() ? LinkEnds::kAtTexels : LinkEnds::kDropped,
            .texels = texels_};
  }

  [[nodiscard]] SolveSettings solve_settings() const {
    return {.bounces = settings_.trace.bounces, .gradient = settings_.trace.gradient};
  }

  /// The place of the first texel that is new.
  std::size_t trace_wanted() {
    const std::size_t first = pyramid_.texels().size();
    const std::vector<std::size_t> texels = pyramid_.wanted();
    Sites sites = sites_.make(texels);
    if (links_ != nullptr) {
      links_->append(sites, run_);
    } else if (sites.size() == 0) {
      throw InvalidInput(fmt::format("{}: no site has a normal and an isovalue in the range", volume_.name));
    } else {
      links_ = std::make_unique<LightLinks>(volume_, std::move(sites), links(kFirstRaysByNeed), run_);
    }
    if (!reflects()) return first;
    // Where light was predicted until now, the prediction is a start.
    for (const std::size_t texel : texels)
      for (int c = 0; c < channels_; ++c)
        start_.push_back(light_.empty() ? 0.0f : light_[texel * std::size_t(channels_) + std::size_t(c)]);
    return first;
  }

  /// The light of the traced texels, and of the others by prediction.
  void solve(BakeResult& result) {
    if (!reflects()) {
      predict(links_->direct(scene_, solve_settings(), run_).samples);
      return;
    }
    const Stopwatch watch;
    draw_labels();
    SolveSettings settings = solve_settings();
    if (settings.bounces != kAllBounces) --settings.bounces;
    const auto to_grid = [&](const SampleSet& samples) { return reflecting_grid(samples.radiance); };
    Solution solution =
        links_->solve(scene_, settings, to_grid, run_, light_.empty() ? std::span<const float>{} : start_);
    start_ = solution.samples.radiance;
    result.sweeps += solution.sweeps + 1;
    predict(std::move(solution.samples));
    // Once more by the prediction itself: corners that stand for texels are one draw, the same for all rays.
    fill_unlit_texels();
    predict(links_->reflecting(scene_, light_, settings, run_));
    result.seconds["bounces"] += watch.seconds();
  }

  void predict(SampleSet samples) {
    traced_light_ = std::move(samples.radiance);
    variance_ = std::move(samples.variance);
    pyramid_.update({.light = traced_light_, .variance = variance_, .rays = links_->rays()}, run_);
    release(light_);
    light_ = pyramid_.light(run_);
  }

  /// Whose light a ray that ends at a texel reads: one site's a texel, so that a sweep costs a pass over the texels.
  void draw_labels() {
    labels_.assign(texels_.count(), kNoLabel);
    const std::span<const std::uint32_t> traced = pyramid_.texels();
    for (std::size_t i = 0; i < traced.size(); ++i) labels_[traced[i]] = std::uint32_t(i);
    pyramid_.draw_labels(labels_, mix_bits(run_.seed ^ 0x6c6162656c), run_);
  }

  [[nodiscard]] IlluminationGrid reflecting_grid(const std::vector<float>& e) const {
    IlluminationGrid grid(texels_, channels_);
    const auto channels = std::size_t(channels_);
    parallel_blocks(texels_.count(), kTexelsABlock, run_, "", [&](const Block& block) {
      for (std::size_t t = block.begin; t < block.end; ++t)
        for (std::size_t c = 0; c < channels; ++c) grid.values[t * channels + c] = e[labels_[t] * channels + c];
    });
    return grid;
  }

  /// Rays may end beside texels that cannot be lit.
  void fill_unlit_texels() {
    const std::vector<std::uint8_t> lit = pyramid_.lit();
    const auto channels = std::size_t(channels_);
    for (std::size_t t = 0; t < lit.size(); ++t)
      if (lit[t] == 0) std::copy_n(&start_[labels_[t] * channels], channels, &light_[t * channels]);
  }

  /// Steps that gain most for a ray, as many as the target is expected to need. False if none gains anything.
  bool take_steps(const HeldOut::SquaredError& found) {
    const double wanted = settings_.target_rmse * settings_.target_rmse;
    if (pyramid_.is_all_traced()) return double_rays(0.88 * wanted / (found.mean + found.standard_error));
    // The error found at the texels held out says how far the figures are off.
    const NeedSteps steps = choose_steps(pyramid_, 0.9 * wanted / found.mean, run_);
    if (steps.single_part > kRough) {
      pyramid_.refine_all();
      trace_wanted();
      return true;
    }
    pyramid_.refine(steps.refined);
    std::vector<std::uint32_t> doubled = steps.doubled;
    for (std::size_t place = trace_wanted(); place < pyramid_.texels().size(); ++place)
      doubled.push_back(std::uint32_t(place));
    static_assert(kRaysByNeed == 2 * kFirstRaysByNeed);
    links_->extend(doubled, run_);
    return !steps.refined.empty() || !steps.doubled.empty();
  }

  /// Where all texels are traced only rays are left to be chosen: by each one's own variance.
  bool double_rays(double goal) {
    const double error = standard_error(variance_);
    const RayBudget budget{.mean_variance = goal * error * error};
    const std::vector<std::uint32_t> sites = sites_to_double(variance_, links_->rays(), budget);
    links_->extend(sites, run_);
    return !sites.empty();
  }

  void finish(BakeResult& result) {
    const Stopwatch watch;
    const auto [least, most] = std::minmax_element(links_->rays().begin(), links_->rays().end());
    result.least_rays = *least;
    result.most_rays = *most;
    result.link_bytes = links_->bytes();
    add(result.counters, links_->counters());
    const std::vector<std::uint8_t> lit = pyramid_.lit();
    result.unlit_texels = std::size_t(std::count(lit.begin(), lit.end(), std::uint8_t(0)));
    result.sites = pyramid_.texels().size();
    result.skipped["texels_predicted"] = texels_.count() - result.unlit_texels - result.sites;
    result.rmse_estimate = std::sqrt(squared_error_);
    if (settings_.wants_error_grid) result.error = filled(errors(lit), 1, lit);
    result.light = filled(std::move(light_), channels_, lit);
    result.light.detail.isovalues = settings_.isovalues;
    result.seconds["resample"] = watch.seconds();
  }

  [[nodiscard]] IlluminationGrid filled(std::vector<float> values, int channels,
                                        const std::vector<std::uint8_t>& lit) const {
    ResampledGrid partial{.grid = IlluminationGrid(texels_, channels), .lit = lit};
    partial.grid.values = std::move(values);
    return fill_unlit(std::move(partial), run_);
  }

  /// The errors that the figures of the cells say, scaled to what was found at the texels held out.
  [[nodiscard]] std::vector<float> errors(const std::vector<std::uint8_t>& lit) const {
    std::vector<float> squared = pyramid_.of_cells([](const TexelPyramid::Cell& cell, const CellFigures& figures) {
      return float(squared_error(figures, cell.level));
    });
    if (pyramid_.is_all_traced())
      for (std::size_t i = 0; i < variance_.size(); ++i) squared[pyramid_.texels()[i]] = variance_[i];
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t t = 0; t < lit.size(); ++t) {
      if (lit[t] == 0) continue;
      sum += double(squared[t]);
      ++count;
    }
    const double scale = sum > 0.0 ? squared_error_ * double(count) / sum : 0.0;
    for (float& value : squared) value = float(std::sqrt(scale * double(value)));
    return squared;
  }

  const Volume& volume_;
  const Scene& scene_;
  const BakeSettings& settings_;
  const Run& run_;
  Lattice texels_;
  int channels_;
  TexelSiteMaker sites_;
  TexelPyramid pyramid_;
  std::unique_ptr<LightLinks> links_;
  std::vector<float> traced_light_;    ///< of pyramid_.texels(), which are the links' sites
  std::vector<float> variance_;        ///< of that
  std::vector<float> start_;           ///< e of the links' sites as far as it is known
  std::vector<std::uint32_t> labels_;  ///< of a texel, the site that stands for it where light is reflected
  std::vector<float> light_;
  double squared_error_ = 0.0;
};

/// Empty if it can be.
std::string why_not(const BakeSettings& settings, const Scene& scene) {
  if (!(settings.target_rmse > 0.0)) return "no error is asked for (target_rmse)";
  if (settings.target_seconds > 0.0) return "a time is given; allowed is an error alone";
  if (settings.trace.bounces != 0 && !iterates(settings))
    return "reflections are followed as paths; allowed is to iterate";
  if (!scene.lights.empty()) return "the scene has light sources";
  if (std::holds_alternative<ImageEnvironment>(scene.environment)) return "the environment is an image";
  if (settings.tracer.name != "wide") return "the tracer is not wide";
  if (settings.sampler.name != "texels" || settings.resampler.name != "direct") return "sites are not at the texels";
  if (!settings.resampler.settings.empty()) return "the resampler has options of its own";
  return {};
}

}  // namespace

BakeResult bake_by_need(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                        const Stages& /*stages*/, const Run& run) {
  const std::string reason = why_not(settings, scene);
  if (!reason.empty()) throw InvalidInput("texels cannot be traced by need: " + reason);
  require_lightable(volume, settings);
  const Lattice texels = texel_lattice(volume.lattice(), settings);
  if (texels.count() > kMostTexels)
    throw InvalidInput(fmt::format("{} texels cannot be traced by need: at most {}", texels.count(), kMostTexels));
  return ByNeed(volume, scene, settings, texels, run).light();
}

}  // namespace isolux
