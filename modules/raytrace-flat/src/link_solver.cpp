#include "link_solver.h"

#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/quantile.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "anderson.h"
#include "ray_sums.h"

namespace isolux {
namespace {

constexpr std::size_t kSitesABlock = 8192;
/// From this albedo on reflections hardly fade, and what an acceleration overshoots stays.
constexpr float kNearlyWhite = 0.999f;
/// Whiter surfaces are taken for that white: what is left to come is at most a hundred times a change then, where there
/// is no bound with albedos of 1.
constexpr double kSlowest = 0.99;
/// Of its light, what a site must lose for that to be more than rounding.
constexpr float kLeastLost = 1e-5f;

/// By what a reflection brings light nearer to what it ends at, at least, by channel.
std::vector<double> contractions(const Scene& scene, std::size_t channels) {
  std::vector<double> most(channels, 0.0);
  for (const auto& key : scene.albedo.keys)
    for (std::size_t c = 0; c < channels; ++c)
      most[c] = std::min(kSlowest, std::max(most[c], double(key.colour[int(c)])));
  return most;
}

/// Whether no value differs by more than a unit in the last place of the largest.
bool differ_by_rounding(const std::vector<float>& one, const std::vector<float>& other) {
  float most = 0.0f;
  float apart = 0.0f;
  for (std::size_t i = 0; i < one.size(); ++i) {
    most = std::max(most, std::fabs(one[i]));
    apart = std::max(apart, std::fabs(one[i] - other[i]));
  }
  return apart <= 0x1p-23f * most;
}

}  // namespace

std::vector<std::uint32_t> LightLinks::Solver::places_of_some(std::size_t count, std::size_t one_of) {
  std::vector<std::uint32_t> places(count, kLeftOut);
  std::uint32_t next = 0;
  for (std::size_t first = 0; first < count; first += one_of) {
    const std::size_t site = first + std::size_t(mix_bits(first) % one_of);
    if (site < count) places[site] = next++;
  }
  return places;
}

LightLinks::Solver::Solver(const LightLinks& links, const Scene& scene, SampleSet straight,
                           std::vector<std::uint32_t> places, const ToGrid& to_grid, const Run& run)
    : links_(links),
      scene_(scene),
      to_grid_(to_grid),
      run_(run),
      places_(std::move(places)),
      channels_(std::size_t(straight.channels)) {
  if (reads_sites())
    straight_ = std::move(straight.radiance);
  else
    gather_seen(std::move(straight));
}

void LightLinks::Solver::gather_seen(SampleSet straight) {
  const Sites& sites = links_.sites_;
  seen_.channels = straight.channels;
  if (places_.empty()) {
    straight_ = std::move(straight.radiance);
    seen_.sites = sites;
    seen_.variance = std::move(straight.variance);
    return;
  }
  for (std::size_t site = 0; site < places_.size(); ++site) {
    if (places_[site] == kLeftOut) continue;
    numbers_.push_back(std::uint32_t(site));
    seen_.sites.positions.push_back(sites.positions[site]);
    seen_.sites.isovalues.push_back(sites.isovalues[site]);
    seen_.sites.normals.push_back(sites.normals[site]);
    seen_.variance.push_back(straight.variance[site]);
    for (std::size_t c = 0; c < channels_; ++c) straight_.push_back(straight.radiance[site * channels_ + c]);
  }
}

TargetLight LightLinks::Solver::before_last(const SolveSettings& settings, std::span<const float> start,
                                            Solution& solution) {
  e_ = straight_;
  std::vector<float> next;
  const bool is_white = is_nearly_white();
  // Lines over the isovalue, which scattered sites are read from, lead beyond the light that there is. Only the last
  // reading is bounded: what iterates is to stay linear, or it does not settle.
  const std::vector<float> most = is_white || !reads_sites() ? most_light() : std::vector<float>{};
  if (settings.bounces != kAllBounces) {
    bool settled = false;
    for (solution.sweeps = 1; solution.sweeps < settings.bounces && !settled; ++solution.sweeps) {
      reflect(at_targets(e_), next);
      settled = differ_by_rounding(next, e_);
      e_.swap(next);
    }
    return bounded(at_targets(e_), most);
  }
  if (start.size() == links_.sites_.isovalues.size() * channels_)
    for (std::size_t i = 0; i < e_.size(); ++i)
      e_[i] = start[numbers_.empty() ? i : numbers_[i / channels_] * channels_ + i % channels_];
  ends_one_of_ = std::max<std::size_t>(settings.ends_one_of, 1);
  Anderson anderson(contractions(scene_, channels_), run_);
  while (solution.sweeps < settings.most_sweeps) {
    ++solution.sweeps;
    reflect(at_targets(e_), next);
    solution.change = anderson.step(e_, next);
    if (is_white) clamp_light(most, anderson.last_image());
    if (run_.progress) run_.progress("bounces", double(solution.sweeps) / double(settings.most_sweeps));
    if (solution.change <= settings.tolerance) break;
  }
  if (run_.progress) run_.progress("bounces", 1.0);
  return bounded(at_targets(e_), most);
}

TargetLight LightLinks::Solver::bounded(TargetLight light, const std::vector<float>& most) {
  std::copy(most.begin(), most.end(), light.most.begin());
  return light;
}

void LightLinks::Solver::clamp_light(const std::vector<float>& most, const std::vector<float>& image) {
  for (std::size_t i = 0; i < e_.size(); ++i)
    if (!(e_[i] >= 0.0f && e_[i] <= most[i % channels_])) e_[i] = std::clamp(image[i], 0.0f, most[i % channels_]);
}

bool LightLinks::Solver::is_nearly_white() const {
  if (!reads_sites()) return false;  // else what is read between texels may lie beyond them
  return largest_albedo(scene_) >= kNearlyWhite;
}

std::vector<float> LightLinks::Solver::most_light() {
  const std::vector<float> one(reads_sites() ? straight_.size() : links_.rounds_->targets->texels().count() * channels_,
                               1.0f);
  std::vector<float> of_one;
  reflect({.values = one, .channels = channels_}, of_one);
  std::vector<float> most(channels_, 0.0f);
  for (std::size_t i = 0; i < straight_.size(); ++i) {
    if (!(straight_[i] > 0.0f)) continue;  // a closed pocket without light bounds nothing
    const float lost = 1.0f - (of_one[i] - straight_[i]);
    const float bound = lost > kLeastLost ? straight_[i] / lost : std::numeric_limits<float>::max();
    most[i % channels_] = std::max(most[i % channels_], bound);
  }
  return most;
}

void LightLinks::Solver::reflect(const TargetLight& light, std::vector<float>& next) const {
  const std::size_t stride = light.stride();
  const std::size_t channels = light.channels;
  const std::vector<float>& levels = isovalues();
  // Without slopes a sum is put where its reflection comes.
  std::vector<float> with_slopes;
  std::vector<float>& sums = light.sloped ? with_slopes : next;
  sums.assign(levels.size() * stride, 0.0f);
  for (const LinkRound& round : links_.rounds_->all)
    add_targets(round, stride, {light.values, places_, ends_one_of_}, sums, run_);
  next.resize(straight_.size());
  const RayCounts rays = links_.kept_rays();
  parallel_blocks(levels.size(), kSitesABlock, run_, "", [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      const std::size_t site = numbers_.empty() ? i : numbers_[i];
      const Vec3f albedo = scene_.albedo.at(levels[i]) / float(rays.of(site));
      for (std::size_t c = 0; c < channels; ++c) {
        float sum = sums[i * stride + c];
        if (light.sloped) sum += sums[i * stride + channels + c] * (levels[i] - light.isovalue);
        next[i * channels + c] = straight_[i * channels + c] + albedo[int(c)] * sum;
      }
    }
  });
}

TargetLight LightLinks::Solver::at_targets(const std::vector<float>& e) {
  if (reads_sites()) return {.values = e, .channels = channels_};
  if (!to_grid_) throw InvalidInput("the sites do not sit at the texels: bounces want a way from samples to a grid");
  seen_.radiance = e;
  IlluminationGrid grid = to_grid_(seen_);
  if (grid.lattice.size != links_.rounds_->targets->texels().size || grid.channels != seen_.channels)
    throw InvalidInput("the grid of reflected light is not of the links' texels and the scene's channels");
  require_complete(grid);
  if (!grid.detail.slopes.empty()) return sloped(grid);
  light_ = std::move(grid.values);
  return {.values = light_, .channels = channels_};
}

TargetLight LightLinks::Solver::sloped(const IlluminationGrid& grid) {
  if (texels_.empty()) measure_texels();
  const auto channels = std::size_t(grid.channels);
  const std::vector<float>& slopes = grid.detail.slopes;
  light_.resize(2 * grid.values.size());
  parallel_blocks(texels_.size(), kSitesABlock, run_, "", [&](const Block& block) {
    for (std::size_t t = block.begin; t < block.end; ++t) {
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t from = t * channels + c;
        const std::size_t to = 2 * t * channels + c;
        light_[to] = grid.values[from] - slopes[from] * texels_[t];
        light_[to + channels] = slopes[from];
      }
    }
  });
  return {.values = light_, .channels = channels, .sloped = true, .isovalue = middle_};
}

void LightLinks::Solver::measure_texels() {
  middle_ = quantile(seen_.sites.isovalues, 0.5);
  texels_ = isovalues_at(links_.volume_, links_.rounds_->targets->texels(), run_);
  for (float& isovalue : texels_) isovalue -= middle_;
}

}  // namespace isolux
