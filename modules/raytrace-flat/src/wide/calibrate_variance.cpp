#include "wide/calibrate_variance.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace isolux::wide {
namespace {

/// Probes of one number of rays that are enough for a scale of their own.
constexpr std::size_t kEnoughProbes = 64;
/// Where nothing is known: half the sky's, twice that of lamps aimed at.
constexpr double kUsualScale = 0.3;
/// Of the mean variance of as many rays, below what sites are told apart by so many levels alone, a level being a
/// sixteenth of the one above and the lowest open.
constexpr double kLowVariance = 1.0 / 16.0;
constexpr std::size_t kLowLevels = 3;
/// Probes that are enough for the variance of those that are low.
constexpr std::size_t kEnoughLow = 16;
/// Sites that are looked at together.
constexpr std::size_t kSitesABlock = 65536;

/// What some probes' variances say and what their differences show.
class Tally {
 public:
  void add(double variance, double found) {
    expected_ += variance;
    squares_ += variance * variance;
    found_ += found;
    ++count_;
  }
  void operator+=(const Tally& more) {
    expected_ += more.expected_;
    squares_ += more.squares_;
    found_ += more.found_;
    count_ += more.count_;
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double mean_expected() const { return expected_ / double(std::max<std::size_t>(count_, 1)); }
  [[nodiscard]] double mean_found() const { return found_ / double(std::max<std::size_t>(count_, 1)); }
  /// What variances are to be multiplied by. Where a few probes have nearly all of the noise, as in a small lamp's
  /// penumbra, they count as so many, and what is thought without them as some more.
  [[nodiscard]] double scale(double without, double part_seen = 1.0) const {
    constexpr double kCountsAs = 4.0;
    if (!(expected_ > 0.0)) return without;
    const double probes = part_seen * (expected_ * expected_ / squares_);
    return (probes * (found_ / expected_) + kCountsAs * without) / (probes + kCountsAs);
  }

 private:
  double expected_ = 0.0;
  double squares_ = 0.0;
  double found_ = 0.0;
  std::size_t count_ = 0;
};

/// What is kept of each number of rays. There are few: doublings of the first.
template <class Value>
class ByRays {
 public:
  [[nodiscard]] Value& operator[](std::uint32_t rays) {
    for (auto& [count, value] : all_)
      if (count == rays) return value;
    return all_.emplace_back(rays, Value{}).second;
  }
  /// Null if nothing is kept.
  [[nodiscard]] const Value* find(std::uint32_t rays) const {
    for (const auto& [count, value] : all_)
      if (count == rays) return &value;
    return nullptr;
  }
  [[nodiscard]] auto begin() const { return all_.begin(); }
  [[nodiscard]] auto end() const { return all_.end(); }

 private:
  std::vector<std::pair<std::uint32_t, Value>> all_;
};

/// The squared difference of a probe's two results, half: the variance of either.
double found_by(const SampleSet& samples, std::size_t probe, const SampleSet& again, std::size_t k) {
  const auto channels = std::size_t(samples.channels);
  double found = 0.0;
  for (std::size_t c = 0; c < channels; ++c) {
    const double d = double(samples.radiance[probe * channels + c]) - double(again.radiance[k * channels + c]);
    found += 0.5 * d * d / double(channels);
  }
  return found;
}

bool are_known(const SampleSet& samples, std::span<const std::size_t> probes) {
  return std::none_of(probes.begin(), probes.end(),
                      [&](std::size_t probe) { return samples.variance[probe] == kUnknownVariance; });
}

/// Of all sites: what their variances say.
Tally tally_of_all(const SampleSet& samples) {
  Tally all;
  for (const float variance : samples.variance)
    if (variance != kUnknownVariance) all.add(double(variance), 0.0);
  return all;
}

/// The same of each number of rays, equal bits for any number of threads.
ByRays<Tally> tallies_of_all(const SampleSet& samples, std::span<const std::uint32_t> rays, const Run& run) {
  std::vector<ByRays<Tally>> parts(block_count(rays.size(), kSitesABlock));
  parallel_blocks(rays.size(), kSitesABlock, run, "", [&](const Block& block) {
    for (std::size_t site = block.begin; site < block.end; ++site)
      if (samples.variance[site] != kUnknownVariance)
        parts[block.index][rays[site]].add(double(samples.variance[site]), 0.0);
  });
  ByRays<Tally> all;
  for (const ByRays<Tally>& part : parts)
    for (const auto& [count, tally] : part) all[count] += tally;
  return all;
}

ByRays<double> scales_of(const ByRays<Tally>& by_rays, double scale) {
  ByRays<double> scales;
  for (const auto& [count, tally] : by_rays)
    if (tally.count() >= kEnoughProbes) scales[count] = tally.scale(scale);
  return scales;
}

double scale_of_all(const Tally& probes, const Tally& sites) {
  const double noise = sites.mean_expected();
  return probes.scale(kUsualScale, noise > 0.0 ? std::min(1.0, probes.mean_expected() / noise) : 1.0);
}

/// What probes show of sites whose own variances say nothing.
class LowVariance {
 public:
  void add_probe(std::uint32_t rays, double found) {
    by_rays_[rays].add(0.0, found);
    // Of other numbers of rays, as variances of nets fall.
    all_.add(0.0, found * std::pow(double(rays), 1.5));
  }
  /// Whether so many probes tell.
  [[nodiscard]] bool is_known() const { return all_.count() >= kEnoughLow; }
  [[nodiscard]] double of(std::uint32_t rays) const {
    const Tally* const own = by_rays_.find(rays);
    if (own != nullptr && own->count() >= kEnoughLow) return own->mean_found();
    return all_.mean_found() * std::pow(double(rays), -1.5);
  }

 private:
  ByRays<Tally> by_rays_;
  Tally all_;
};

/// Which sites' own variances say little, and how luck is told: by level, and those beside others of the list that do
/// have noise are likelier lucky than those among their like.
class Luck {
 public:
  /// `by_rays`: tallies_of_all().
  Luck(const SampleSet& samples, std::span<const std::uint32_t> rays, const ByRays<Tally>& by_rays, const Run& run)
      : levels_(rays.size()) {
    parallel_blocks(rays.size(), kSitesABlock, run, "", [&](const Block& block) {
      for (std::size_t site = block.begin; site < block.end; ++site) {
        const Tally* const like = by_rays.find(rays[site]);
        double limit = like != nullptr ? like->mean_expected() : 0.0;
        while (levels_[site] < kLowLevels && double(samples.variance[site]) <= (limit *= kLowVariance)) ++levels_[site];
      }
    });
  }

  /// Null for those whose own variance does say something.
  [[nodiscard]] LowVariance* of(std::size_t site) {
    if (levels_[site] == 0) return nullptr;
    const bool among_like =
        (site == 0 || levels_[site - 1] != 0) && (site + 1 == levels_.size() || levels_[site + 1] != 0);
    return &(among_like ? among_like_ : beside_others_)[levels_[site] - 1u];
  }

 private:
  std::vector<std::uint8_t> levels_;  ///< 0: not low
  std::array<LowVariance, kLowLevels> among_like_;
  std::array<LowVariance, kLowLevels> beside_others_;
};

}  // namespace

void calibrate_variance(SampleSet& samples, std::span<const std::size_t> probes, const SampleSet& again,
                        std::span<const std::uint32_t> rays) {
  if (!are_known(samples, probes)) return;
  Tally all;
  ByRays<Tally> by_rays;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const auto variance = double(samples.variance[probes[k]]);
    const double found = found_by(samples, probes[k], again, k);
    all.add(variance, found);
    if (!rays.empty()) by_rays[rays[probes[k]]].add(variance, found);
  }
  const double scale = scale_of_all(all, tally_of_all(samples));
  const ByRays<double> scales = scales_of(by_rays, scale);
  for (std::size_t site = 0; site < samples.variance.size(); ++site) {
    if (samples.variance[site] == kUnknownVariance) continue;
    const double* const own = rays.empty() ? nullptr : scales.find(rays[site]);
    const auto by = float(own != nullptr ? *own : scale);
    samples.variance[site] *= by;
    if (!samples.lamps_variance.empty()) samples.lamps_variance[site] *= by;
  }
}

void calibrate_variance_of_chosen(SampleSet& samples, std::span<const std::size_t> probes, const SampleSet& again,
                                  std::span<const std::uint32_t> rays, const Run& run) {
  if (!are_known(samples, probes)) return;
  const ByRays<Tally> tallies = tallies_of_all(samples, rays, run);
  Luck luck(samples, rays, tallies, run);
  Tally all;
  ByRays<Tally> by_rays;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const float variance = samples.variance[probes[k]];
    const std::uint32_t count = rays[probes[k]];
    const double found = found_by(samples, probes[k], again, k);
    if (LowVariance* const low = luck.of(probes[k])) {
      low->add_probe(count, found);
    } else {
      all.add(double(variance), found);
      by_rays[count].add(double(variance), found);
    }
  }
  Tally sites;
  for (const auto& [count, tally] : tallies) sites += tally;
  const double scale = scale_of_all(all, sites);
  const ByRays<double> scales = scales_of(by_rays, scale);
  parallel_blocks(rays.size(), kSitesABlock, run, "", [&](const Block& block) {
    for (std::size_t site = block.begin; site < block.end; ++site) {
      float& variance = samples.variance[site];
      if (variance == kUnknownVariance) continue;
      const double* const own = scales.find(rays[site]);
      const auto by = float(own != nullptr ? *own : scale);
      if (!samples.lamps_variance.empty()) samples.lamps_variance[site] *= by;
      const LowVariance* const low = luck.of(site);
      variance = low != nullptr && low->is_known() ? float(low->of(rays[site])) : by * variance;
    }
  });
}

}  // namespace isolux::wide
