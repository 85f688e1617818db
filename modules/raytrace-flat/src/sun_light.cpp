#include "sun_light.h"

#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "light_sources.h"
#include "shadow_edges.h"
#include "wide/aimer.h"
#include "wide/net_mean.h"
#include "wide/trace_blocks.h"

namespace isolux {
namespace {

/// A site's first rays say whether there is an edge.
constexpr int kFirst = 4;
constexpr int kOneOf = 8;  ///< or so large a part of all, if that is more
constexpr int kMostTimes = 16;
/// Of what sees a part, by the squares of its light, so much may be alone, times the rays^1.5 that its error falls
/// with.
constexpr double kMissed = 0.5;

/// Who asks a sun, and what with so many rays each.
class SunRays {
 public:
  SunRays(const Volume& volume, const SunLight& sun, std::uint32_t number, std::size_t rays, std::uint64_t seed)
      : towards_(glm::normalize(Vec3(sun.direction))),
        disc_(sun_disc(sun)),
        sine_(std::sqrt(disc_.one_minus_cosine * (2.0 - disc_.one_minus_cosine))),
        seed_(mix_bits(mix_bits(seed ^ 0x53756E) + number)),
        to_index_(volume.lattice().frame),
        points_(rays),
        mean_(points_, rays),
        rays_(rays) {}

  /// Adds what the sites of a block that face any of the sun get.
  void light(const wide::SiteBlock& block, SampleSet& samples, TraceCounters& counters) const {
    ask(block, samples.sites, counters,
        [&](const wide::Batch& batch, std::size_t first, std::uint32_t site) { add(batch, first, site, samples); });
  }

  /// Says what they see.
  void look(const wide::SiteBlock& block, const Sites& sites, std::vector<LampSeen>& seen,
            TraceCounters& counters) const {
    ask(block, sites, counters, [&](const wide::Batch& batch, std::size_t first, std::uint32_t site) {
      const auto t = std::span(batch.rays.t).subspan(first, rays_);
      const auto escaped = std::size_t(std::count(t.begin(), t.end(), wide::kEscaped));
      const LampSeen parted = escaped == 0 ? LampSeen::kNone : LampSeen::kSome;
      const LampSeen found = escaped == rays_ ? LampSeen::kAll : parted;
      seen[site] = sees_all_above(sites.normals[site]) ? found : LampSeen::kRising;
    });
  }

  /// e of a site that sees the whole disc: the mean of its directions is along the axis.
  [[nodiscard]] Vec3 whole(const Vec3f& normal) const {
    const double along = 1.0 - 0.5 * disc_.one_minus_cosine;
    return disc_.weight * (std::numbers::inv_pi * along * glm::dot(Vec3(normal), towards_));
  }
  [[nodiscard]] bool faces(const Vec3f& normal) const {
    // The disc's edge is asin(sine) from its middle; a rounding more does no harm.
    return normal != Vec3f(0.0f) && glm::dot(Vec3(normal), towards_) > -sine_ - kRounding;
  }

 private:
  static constexpr double kRounding = 1e-6;

  [[nodiscard]] bool sees_all_above(const Vec3f& normal) const {
    return glm::dot(Vec3(normal), towards_) > sine_ + kRounding;
  }

  /// Traces the rays of a block, and calls answered(batch, first ray, site).
  template <class Answered>
  void ask(const wide::SiteBlock& block, const Sites& sites, TraceCounters& counters, const Answered& answered) const {
    static thread_local wide::Batch batch;
    static thread_local std::vector<std::uint32_t> facing;
    batch.clear(block.sites.size() * rays_);
    facing.clear();
    for (const std::uint32_t site : block.sites) {
      if (!faces(sites.normals[site])) continue;
      facing.push_back(site);
      aim(sites, site, batch);
    }
    if (facing.empty()) return;
    trace(block.field, block.occupancy, block.inner, wide::Question::kAnyHit, batch.rays, counters);
    const auto& t = batch.rays.t;
    const auto end = t.begin() + std::ptrdiff_t(batch.rays.count);
    counters.hits += batch.rays.count - std::uint64_t(std::count(t.begin(), end, wide::kEscaped));
    for (std::size_t i = 0; i < facing.size(); ++i) answered(batch, i * rays_, facing[i]);
  }

  void aim(const Sites& sites, std::size_t site, wide::Batch& batch) const {
    const std::uint64_t bits = mix_bits(seed_ + site);
    const Vec3f& p = sites.positions[site];
    const wide::Pose pose{.position = {p.x, p.y, p.z},
                          .isovalue = sites.isovalues[site],
                          .normal = {float(towards_.x), float(towards_.y), float(towards_.z)},
                          .shift_u = std::uint32_t(bits),
                          .shift_v = std::uint32_t(bits >> 32)};
    wide::aim_cone(float(disc_.one_minus_cosine), pose, points_, rays_, to_index_, batch.rays.count, batch.rays,
                   batch.world);
    batch.rays.count += rays_;
  }

  void add(const wide::Batch& batch, std::size_t first, std::uint32_t site, SampleSet& samples) const {
    static thread_local std::vector<Vec3> values;
    values.assign(rays_, Vec3(0.0));
    const Vec3 normal(samples.sites.normals[site]);
    for (std::size_t k = 0; k < rays_; ++k) {
      const std::size_t ray = first + k;
      if (batch.rays.t[ray] != wide::kEscaped) continue;
      const Vec3 towards(batch.world.axis[0][ray], batch.world.axis[1][ray], batch.world.axis[2][ray]);
      values[k] = std::max(0.0, glm::dot(normal, towards)) * std::numbers::inv_pi * disc_.weight;
    }
    mean_.add(mean_.moments(values), site, samples);
  }

  Vec3 towards_;
  SunDisc disc_;
  double sine_;  ///< of the angle between the disc's middle and its edge
  std::uint64_t seed_;
  wide::ToIndex to_index_;
  wide::SobolPoints points_;
  wide::NetMean mean_;
  std::size_t rays_;
};

void add_whole(const Vec3& light, std::size_t site, SampleSet& samples) {
  const auto channels = std::size_t(samples.channels);
  for (std::size_t c = 0; c < channels; ++c) samples.radiance[site * channels + c] += float(light[int(c)]);
}

/// What a few rays of all sites that face a sun saw.
struct FirstLook {
  SunRays rays;
  int count;  ///< of them, a site
  std::vector<LampSeen> seen;
};

/// Whether sites tell what those close by see, as far as is known from those that saw a part. One more might have been
/// alone: few sites can agree by chance.
bool tell_each_other(const FirstLook& look, const Sites& sites, std::span<const std::uint32_t> alone, int rays) {
  const auto square = [&](std::size_t site) {
    const Vec3 light = look.rays.whole(sites.normals[site]);
    return glm::dot(light, light);
  };
  double found = 0.0;
  double count = 0.0;
  for (std::size_t site = 0; site < look.seen.size(); ++site) {
    if (look.seen[site] != LampSeen::kSome) continue;
    found += square(site);
    count += 1.0;
  }
  if (count == 0.0) return false;
  const double missed = std::accumulate(alone.begin(), alone.end(), found / count,
                                        [&](double sum, std::uint32_t site) { return sum + square(site); });
  return missed * std::pow(double(rays), 1.5) <= kMissed * found;
}

/// Of each site that is asked.
int rays_near_edges(const TraceSettings& settings, const FirstLook& look, const std::vector<bool>& near) {
  const auto facing =
      double(look.seen.size()) - double(std::count(look.seen.begin(), look.seen.end(), LampSeen::kTurnedAway));
  const auto asked = double(std::count(near.begin(), near.end(), true));
  int times = 1;
  while (times < kMostTimes && look.count * facing + 2.0 * times * settings.rays * asked <= settings.rays * facing)
    times *= 2;
  return times * settings.rays;
}

/// Who is to be asked how often. Adds to the variance what this may leave out.
SunQuestions ask_near_edges(const TraceSettings& settings, const FirstLook& look, SampleSet& samples) {
  ShadowEdges edges = find_shadow_edges(samples.sites, look.seen);
  if (!tell_each_other(look, samples.sites, edges.alone, settings.rays))
    return {.asked = std::vector<bool>(look.seen.size(), true), .rays = settings.rays};
  for (const std::uint32_t site : edges.alone) {
    // As many are not found, which see less than a ray's share of the disc, or all but that.
    const Vec3 wrong = look.rays.whole(samples.sites.normals[site]) / (2.0 * look.count);
    samples.variance[site] += float(samples.channels == 1 ? wrong.x * wrong.x : glm::dot(wrong, wrong) / 3.0);
  }
  const int rays = rays_near_edges(settings, look, edges.near);
  return {.asked = std::move(edges.near), .rays = rays};
}

}  // namespace

TraceCounters add_sun_light(const Volume& volume, OuterSide outer, const SunLight& sun, std::uint32_t number,
                            const TraceSettings& settings, const Run& run, SampleSet& samples) {
  const auto rays = std::size_t(settings.rays);
  const SunRays towards(volume, sun, number, rays, run.seed);
  return wide::trace_blocks(
      volume, samples.sites, {.outer = outer, .rays_per_site = rays}, run,
      [&](const wide::SiteBlock& block, TraceCounters& counters) { towards.light(block, samples, counters); });
}

TraceCounters add_sun_light_by_edges(const Volume& volume, OuterSide outer, const SunLight& sun, std::uint32_t number,
                                     const TraceSettings& settings, const Run& run, SampleSet& samples,
                                     SunQuestions& questions) {
  const bool is_point = sun_disc(sun).one_minus_cosine == 0.0;
  const int first = is_point ? 1 : std::max(kFirst, settings.rays / kOneOf);
  FirstLook look{.rays = {volume, sun, number, std::size_t(first), run.seed},
                 .count = first,
                 .seen = std::vector<LampSeen>(samples.size(), LampSeen::kTurnedAway)};
  TraceCounters counters =
      wide::trace_blocks(volume, samples.sites, {.outer = outer, .rays_per_site = std::size_t(first)}, run,
                         [&](const wide::SiteBlock& block, TraceCounters& part) {
                           look.rays.look(block, samples.sites, look.seen, part);
                         });
  if (questions.asked.empty() && is_point) questions.asked.resize(samples.size());
  if (questions.asked.empty()) questions = ask_near_edges(settings, look, samples);
  std::vector<std::uint32_t> asked;
  for (std::size_t site = 0; site < samples.size(); ++site) {
    const LampSeen seen = look.seen[site];
    if (seen == LampSeen::kTurnedAway) continue;
    if (!is_point && (questions.asked[site] || seen == LampSeen::kSome)) {
      asked.push_back(std::uint32_t(site));
    } else {
      counters.known += std::uint64_t(settings.rays - first);
      if (seen == LampSeen::kAll) add_whole(look.rays.whole(samples.sites.normals[site]), site, samples);
    }
  }
  if (asked.empty()) return counters;
  const auto rays = std::size_t(questions.rays);
  const SunRays many(volume, sun, number, rays, run.seed);
  add(counters,
      wide::trace_blocks(volume, samples.sites, {.outer = outer, .rays_per_site = rays, .only = asked}, run,
                         [&](const wide::SiteBlock& block, TraceCounters& part) { many.light(block, samples, part); }));
  return counters;
}

}  // namespace isolux
