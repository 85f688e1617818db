#include "sites_by_need.h"

#include <isolux/bake/find_sites.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/core/stopwatch.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "bake_parts.h"
#include "checked_stages.h"
#include "texel_judge.h"

namespace isolux {
namespace {

constexpr std::uint32_t kKeep = 0x6e656564u;  // of the random numbers that keep candidates
constexpr double kLeastSpread = 1e-4;         // of the light's: even smooth cells get some
constexpr int kBisections = 60;
constexpr std::size_t kCandidates = 4;               // of each site to be drawn by need
constexpr std::uint64_t kSecondHalf = 0x5a5a5a5aul;  // between the seeds of the halves

class CellSpread {
 public:
  CellSpread(const Volume& volume, const SampleSet& samples, const Run& run)
      : cells_(glm::max(volume.lattice().size - 1, Index3(1))) {
    const std::size_t count = std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z);
    std::vector<float> squares(count, 0.0f);
    std::vector<float> degrees(count, 0.0f);
    tally(samples, squares, degrees);
    spread_.resize(count);
    parallel_blocks(std::size_t(cells_.z), 1, run, "", [&](const Block& block) {
      const auto k = int(block.begin);
      for (int j = 0; j < cells_.y; ++j)
        for (int i = 0; i < cells_.x; ++i) spread_[number({i, j, k})] = around({i, j, k}, squares, degrees);
    });
  }

  /// Of the light in the cell of a point, a standard deviation.
  [[nodiscard]] double at(const Vec3f& position) const { return double(spread_[number(cell_of(position))]); }

 private:
  [[nodiscard]] Index3 cell_of(const Vec3f& position) const { return glm::min(Index3(position), cells_ - 1); }
  [[nodiscard]] std::size_t number(const Index3& cell) const {
    return (std::size_t(cell.z) * std::size_t(cells_.y) + std::size_t(cell.y)) * std::size_t(cells_.x) +
           std::size_t(cell.x);
  }

  /// Squared differences of each cell's samples from their mean, less the rays' noise in them, and how many are free.
  void tally(const SampleSet& samples, std::vector<float>& squares, std::vector<float>& degrees) const {
    const auto channels = std::size_t(samples.channels);
    std::vector<float> means(squares.size() * channels, 0.0f);
    std::vector<float> counts(squares.size(), 0.0f);
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const std::size_t cell = number(cell_of(samples.sites.positions[s]));
      counts[cell] += 1.0f;
      for (std::size_t c = 0; c < channels; ++c) {
        float& mean = means[cell * channels + c];
        mean += (samples.radiance[s * channels + c] - mean) / counts[cell];
      }
    }
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const std::size_t cell = number(cell_of(samples.sites.positions[s]));
      if (counts[cell] < 2.0f || !(samples.variance[s] < kUnknownVariance)) continue;
      const float free = 1.0f - 1.0f / counts[cell];
      degrees[cell] += free;
      squares[cell] -= free * samples.variance[s];
      for (std::size_t c = 0; c < channels; ++c) {
        const float d = samples.radiance[s * channels + c] - means[cell * channels + c];
        squares[cell] += d * d / float(channels);
      }
    }
  }

  [[nodiscard]] float around(const Index3& cell, const std::vector<float>& squares,
                             const std::vector<float>& degrees) const {
    const Index3 low = glm::max(cell - 1, Index3(0));
    const Index3 high = glm::min(cell + 1, cells_ - 1);
    float sum = 0.0f;
    float free = 0.0f;
    for (int k = low.z; k <= high.z; ++k)
      for (int j = low.y; j <= high.y; ++j)
        for (int i = low.x; i <= high.x; ++i) {
          sum += squares[number({i, j, k})];
          free += degrees[number({i, j, k})];
        }
    return free > 0.0f ? std::sqrt(std::max(0.0f, sum / free)) : 0.0f;
  }

  Index3 cells_;
  std::vector<float> spread_;
};

/// The factor that makes probabilities min(1, factor * need) add up to `count`.
double factor_for(const std::vector<float>& needs, double count) {
  const auto kept = [&](double factor) {
    double sum = 0.0;
    for (const float need : needs) sum += std::min(1.0, factor * double(need));
    return sum;
  };
  const double least = double(*std::min_element(needs.begin(), needs.end()));
  double low = 0.0;
  double high = 1.0 / least;
  for (int n = 0; n < kBisections; ++n) {
    const double middle = 0.5 * (low + high);
    (kept(middle) < count ? low : high) = middle;
  }
  return high;
}

}  // namespace

Sites sites_by_need(const Volume& volume, const SampleSet& first, const Sites& candidates, std::size_t count,
                    const Run& run) {
  Sites sites;
  if (candidates.size() == 0) return sites;
  const CellSpread spread(volume, first, run);
  double power = 0.0;
  for (const float e : first.radiance) power += double(e) * double(e);
  const double least = kLeastSpread * std::sqrt(power / double(std::max<std::size_t>(first.radiance.size(), 1))) +
                       double(std::numeric_limits<float>::min());
  std::vector<float> needs(candidates.size());
  for (std::size_t i = 0; i < needs.size(); ++i) needs[i] = float(std::max(least, spread.at(candidates.positions[i])));
  const double factor = factor_for(needs, double(count));
  for (std::size_t i = 0; i < needs.size(); ++i) {
    if (RandomStream(run.seed, i, kKeep).uniform_double() >= factor * double(needs[i])) continue;
    sites.positions.push_back(candidates.positions[i]);
    sites.isovalues.push_back(candidates.isovalues[i]);
    sites.normals.push_back(candidates.normals[i]);
  }
  return sites;
}

void append_samples(SampleSet& all, const SampleSet& more) {
  assert(all.channels == more.channels);
  const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  add(all.sites.positions, more.sites.positions);
  add(all.sites.isovalues, more.sites.isovalues);
  add(all.sites.normals, more.sites.normals);
  add(all.radiance, more.radiance);
  add(all.variance, more.variance);
}

BakeResult bake_scattered_by_need(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                                  const Stages& stages, const Run& run) {
  if (has_target(settings))
    throw InvalidInput("scattered sites by need: a number of rays is allowed, not an error or a time");
  if (iterates(settings) && settings.trace.bounces != 0)
    throw InvalidInput("scattered sites by need: reflections are followed by paths, not iterated");
  const auto resampler = stages.resamplers.create(settings.resampler.name, settings.resampler.settings);
  const auto tracer = checked_tracer(settings.tracer, stages);
  const Lattice texels = texel_lattice(volume.lattice(), settings);
  BakeSettings even = settings;
  even.samples = (settings.samples + 1) / 2;
  const double one_a_texel = double(texels.count()) / double(cell_lattice(volume.lattice()).count());
  even.sites_a_cell = 0.5 * (settings.sites_a_cell > 0.0 ? settings.sites_a_cell : one_a_texel);
  FoundSites found = find_sites(volume, scene.outer, even, stages, run);
  const std::size_t count = found.sites.size();
  BakeResult result = std::move(found.begun);
  Stopwatch watch;
  TraceResult traced = tracer->trace(volume, scene, std::move(found.sites), settings.trace, run);
  result.seconds["trace"] = watch.seconds();

  // Other random numbers, or the sites drawn would be the same ones again.
  Run second = run;
  second.seed = run.seed + kSecondHalf;
  even.samples = kCandidates * count;
  FoundSites drawn = find_sites(volume, scene.outer, even, stages, second);
  Sites sites = sites_by_need(volume, traced.samples, drawn.sites, count, second);
  result.seconds["sites"] += drawn.begun.seconds["sites"];
  result.sites += sites.size();
  watch = Stopwatch();
  const TraceResult more = tracer->trace(volume, scene, std::move(sites), settings.trace, second);
  result.seconds["trace"] += watch.seconds();
  append_samples(traced.samples, more.samples);
  result.counters = traced.counters;
  add(result.counters, more.counters);
  result.least_rays = result.most_rays = std::uint32_t(settings.trace.rays);
  finish_bake(volume, traced.samples, *resampler, texels, settings, run, result);
  if (!are_sites_own(*resampler, settings)) judge_texels(volume, scene, settings, run, result);
  return result;
}

}  // namespace isolux
