#include <fmt/format.h>
#include <isolux/bake/choose_texels.h>
#include <isolux/core/error.h>
#include <isolux/core/field.h>
#include <isolux/core/quantile.h>
#include <isolux/resample/openness.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "bake_parts.h"
#include "checked_stages.h"
#include "resampling_choice.h"
#include "texel_readings.h"

namespace isolux {
namespace {

constexpr std::array<double, 6> kRatios = {0.25, 0.5, 0.75, 1.0, 1.5, 2.0};
constexpr std::size_t kPoints = 1000;  // the rms of an error is known to some 5 percent
constexpr int kPointRays = 256;
/// A bake tells near-field weights by texels between two others that have light of their own. Where less of what is
/// read is such light there are few, and nobody knows beforehand what they will say.
constexpr double kOwnEnough = 0.75;
constexpr int kTexelRays = 64;  // whatever the bake will spend: exact texels are asked about

/// Of the slopes there are, what nine in ten do not exceed; so many times that and no more counts. A spike of the
/// volume, thousands of times as steep as the rest, would otherwise be all that counts.
constexpr double kUsualPart = 0.9;
constexpr double kMostOfUsual = 4.0;

/// Random points of random level sets, the light there, and how much area of how many level sets each stands for.
struct Reference {
  SampleSet samples;
  std::vector<double> weights;
};

/// Caps what points weigh that a spike made steep.
void cap(std::vector<double>& weights) {
  const double steepest = *std::max_element(weights.begin(), weights.end());
  std::vector<float> steep;  // as parts of it, which floats hold
  for (const double weight : weights)
    if (weight > 0.0) steep.push_back(float(weight / steepest));
  const double most = kMostOfUsual * steepest * double(quantile(steep, kUsualPart));
  for (double& weight : weights) weight = std::min(weight, most);
}

Reference trace_reference(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                          const FlatTracer& tracer, const Stages& stages, const Run& run, TraceCounters& counters) {
  const auto sampler = stages.samplers.create(settings.isovalues ? "level_sets" : "random");
  SiteRequest request{.texels = cell_lattice(volume.lattice()),
                      .count = kPoints,
                      .isovalues = settings.isovalues,
                      .outer = scene.outer,
                      .gradient = settings.trace.gradient};
  Sites sites = sampler->sample(volume, request, run);
  if (sites.size() == 0)
    throw InvalidInput(fmt::format("{}: no site has a normal and an isovalue in the range", volume.name));
  Reference reference;
  const TrilinearField field(volume);
  for (const Vec3f& position : sites.positions) {
    // Points even in space lie the sparser on a level set the steeper the field is (the coarea formula).
    const Vec3 gradient = field.world_gradient(Vec3(position), GradientKind::kCentralDifferences);
    reference.weights.push_back(settings.isovalues ? 1.0 : glm::length(gradient));
  }
  cap(reference.weights);
  TraceSettings rays = settings.trace;
  rays.rays = kPointRays;
  TraceResult traced = tracer.trace(volume, scene, std::move(sites), rays, run);
  counters.rays += traced.counters.rays;
  reference.samples = std::move(traced.samples);
  return reference;
}

/// The mean over the reference's level sets.
Vec3 usual_openness(const Reference& reference, const std::vector<Vec3f>& openness) {
  Vec3 sum(0.0);
  double total = 0.0;
  for (std::size_t p = 0; p < openness.size(); ++p) {
    sum += reference.weights[p] * Vec3(openness[p]);
    total += reference.weights[p];
  }
  return total > 0.0 ? sum / total : sum;
}

/// Judges readings against the reference.
class Judge {
 public:
  Judge(const Reference& reference, const Readings& read, const std::vector<Vec3f>& openness)
      : reference_(reference), read_(read), openness_(openness), channels_(std::size_t(reference.samples.channels)) {}

  /// rms of reading less truth, the variance of both taken out. With near-field terms, of a grid of so many texels,
  /// where they help.
  [[nodiscard]] double error(std::size_t texels) const {
    const double plain = error_with([](std::size_t /*point*/, std::size_t /*channel*/) { return Vec3(0.0); });
    if (openness_.empty() || read_.own < kOwnEnough) return plain;
    // What a half of the points says of the weights is tried on the other half.
    std::array<std::vector<Vec3>, 2> weights;
    for (std::size_t half = 0; half < 2; ++half) weights[half] = near_field_weights(1 - half, 3.0 * double(texels));
    return std::min(plain, error_with([&](std::size_t p, std::size_t c) { return weights[p % 2][c]; }));
  }

 private:
  [[nodiscard]] double truth_beyond(std::size_t point, std::size_t channel) const {
    const std::size_t v = point * channels_ + channel;
    return double(reference_.samples.radiance[v]) - read_.light[v];
  }
  [[nodiscard]] Vec3 openness_beyond(std::size_t point) const {
    return openness_.empty() ? Vec3(0.0) : Vec3(openness_[point]) - read_.openness[point];
  }

  /// Those with which openness foretells what reading misses, by channel; kept or not as those of a bake's are, which
  /// come of `rows` differences between texels. Steep places count by their steepness's root there, too.
  [[nodiscard]] std::vector<Vec3> near_field_weights(std::size_t half, double rows) const {
    NearFieldFit fit;
    Vec3 squares(0.0);
    for (std::size_t p = half; p < reference_.samples.size(); p += 2) {
      Vec3 missed(0.0);
      for (std::size_t c = 0; c < channels_; ++c) {
        missed[int(c)] = truth_beyond(p, c);
        squares[int(c)] += std::pow(double(reference_.samples.radiance[p * channels_ + c]), 2.0);
      }
      fit.add(openness_beyond(p), missed, int(channels_), std::sqrt(reference_.weights[p]));
    }
    std::vector<Vec3> weights;
    for (std::size_t c = 0; c < channels_; ++c) {
      const double light = std::sqrt(squares[int(c)] / std::max(fit.rows(), 1.0));
      weights.push_back(fit.weights(int(c), light, rows).value_or(Vec3(0.0)));
    }
    return weights;
  }

  template <class Weights>
  [[nodiscard]] double error_with(const Weights& weights) const {
    double squares = 0.0;
    double total = 0.0;
    for (std::size_t p = 0; p < reference_.samples.size(); ++p) {
      double square = 0.0;
      for (std::size_t c = 0; c < channels_; ++c) {
        const double missed = truth_beyond(p, c) - glm::dot(weights(p, c), openness_beyond(p));
        square += missed * missed / double(channels_);
      }
      const double noise = double(reference_.samples.variance[p]) + read_.variance[p];
      squares += reference_.weights[p] * (square - noise);
      total += reference_.weights[p];
    }
    return total > 0.0 ? std::sqrt(std::max(0.0, squares / total)) : std::numeric_limits<double>::infinity();
  }

  const Reference& reference_;
  const Readings& read_;
  const std::vector<Vec3f>& openness_;
  std::size_t channels_;
};

/// Whether the bake's light will be read with near-field terms.
bool has_near_field(BakeSettings settings, const Stages& stages) {
  name_resampling(settings);
  return settings.texel_sites == TexelSites::kAll &&
         stages.resamplers.create(settings.resampler.name, settings.resampler.settings)->has_near_field();
}

/// What the side that wants more texels wants.
TexelChoice choose_for_both(const Volume& volume, const Scene& scene, const BakeSettings& settings, double target,
                            const Stages& stages, const Run& run) {
  const auto choose = [&](LevelSetSide side) {
    return choose_texels(volume, scene_of_side(scene, side), settings, target, stages, run);
  };
  TexelChoice both = choose(LevelSetSide::kOuter);
  const TexelChoice inner = choose(LevelSetSide::kInner);
  both.texels = glm::max(both.texels, inner.texels);
  both.error = std::max(both.error, inner.error);
  add(both.counters, inner.counters);
  return both;
}

}  // namespace

Index3 texels_by_ratio(const Lattice& volume, double ratio) {
  constexpr double kMost = std::numeric_limits<int>::max();
  const Vec3 wanted = glm::round(Vec3(volume.size - 1) * ratio);
  if (!(ratio > 0.0) || std::max({wanted.x, wanted.y, wanted.z}) > kMost) {
    throw InvalidInput(fmt::format("{} texels a cell of {}x{}x{} grid points: allowed is above 0 and up to {} an axis",
                                   ratio, volume.size.x, volume.size.y, volume.size.z, kMost));
  }
  return glm::max(Index3(wanted), Index3(1));
}

TexelChoice choose_texels(const Volume& volume, const Scene& scene, const BakeSettings& settings, double target,
                          const Stages& stages, const Run& run) {
  require_level_sets(volume, settings);
  if (settings.lattice == TexelLattice::kVoxels)
    throw InvalidInput("texels at the voxels: their number is the volume's and cannot be chosen");
  if (scene.sides == LitSides::kBoth) return choose_for_both(volume, scene, settings, target, stages, run);
  const auto tracer = checked_tracer(settings.tracer, stages);
  TexelChoice best{.texels = Index3(1), .error = std::numeric_limits<double>::infinity(), .counters = {}};
  const Reference reference = trace_reference(volume, scene, settings, *tracer, stages, run, best.counters);
  TraceSettings rays = settings.trace;
  rays.rays = kTexelRays;
  const bool near_field = has_near_field(settings, stages);
  const auto openness_of = [&](const Sites& sites) {
    return near_field ? openness_before(volume, sites) : std::vector<Vec3f>{};
  };
  const std::vector<Vec3f> openness = openness_of(reference.samples.sites);
  const Vec3 usual = usual_openness(reference, openness);
  Run other = run;
  for (const double ratio : kRatios) {
    const Lattice texels = cell_lattice(volume.lattice(), texels_by_ratio(volume.lattice(), ratio));
    TexelsAround around = texels_around(volume, scene.outer, texels, reference.samples.sites, settings.trace.gradient);
    if (around.sites.size() == 0) continue;  // a bake would have none to trace
    ++other.seed;                            // rays of a texel and of a point must not be the same ones
    const std::vector<Vec3f> before_texels = openness_of(around.sites);
    const TraceResult traced = tracer->trace(volume, scene, std::move(around.sites), rays, other);
    best.counters.rays += traced.counters.rays;
    const Readings read = read_between(around, traced.samples, before_texels, usual);
    const double error = Judge(reference, read, openness).error(texels.count());
    if (error < best.error) {
      best.texels = texels.size;
      best.error = error;
    }
    if (error <= target) break;
  }
  return best;
}

}  // namespace isolux
