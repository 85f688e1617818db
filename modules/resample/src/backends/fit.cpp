#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/resample/resampler.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit_system.h"
#include "samples.h"

namespace isolux::backends {
namespace {

class Fit final : public Resampler {
 public:
  struct Options {
    bool slopes = true;
    bool normals = true;
    bool near_field = true;
    double value_prior = 0.1;
    double slope_prior = 0.03;
    double normal_prior = 0.03;
    int iterations = 4;

    void describe(OptionVisitor& option) {
      option("slopes", slopes, {.help = "a second number a texel: how its light changes with the isovalue"});
      option("normals", normals,
             {.help = "three more numbers a texel: how its light changes with the surface's normal"});
      option("near_field", near_field, {.help = "weigh in how open the volume itself is in front of a point"});
      option("value_prior", value_prior,
             {.min = 1e-6,
              .max = 1e3,
              .unit = "samples",
              .help = "weight of the mean light around a texel in its value; grows with the samples' noise"});
      option("slope_prior", slope_prior,
             {.min = 1e-6,
              .max = 1e3,
              .unit = "samples",
              .help = "weight of no change with the isovalue in its slope; grows with the samples' noise"});
      option("normal_prior", normal_prior,
             {.min = 1e-6,
              .max = 1e3,
              .unit = "samples",
              .help = "weight of no change with the normal in a texel; grows with the samples' noise"});
      option("iterations", iterations,
             {.min = 1, .max = 1000, .help = "of the conjugate gradients in each of three rounds"});
    }
  };
  explicit Fit(const Options& options) : options_(options) {}

  [[nodiscard]] bool has_near_field() const override { return options_.near_field; }

  ResampledGrid resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                         const Run& run) const override {
    require_samples(samples);
    require_texels(texels);
    const FitTerms terms{.slopes = options_.slopes, .normals = options_.normals};
    const FitSystem system(volume, samples, texels, terms,
                           options_.near_field ? NearFieldUse::kFitted : NearFieldUse::kNone, run);
    ResampledGrid result{.grid = IlluminationGrid(texels, samples.channels),
                         .lit = std::vector<std::uint8_t>(texels.count(), 0)};
    LightDetail& detail = result.grid.detail;
    detail.ceiling = *std::max_element(samples.radiance.begin(), samples.radiance.end());
    if (terms.slopes) detail.slopes.assign(result.grid.values.size(), 0.0f);
    for (std::vector<float>& slopes : detail.normal_slopes)
      if (terms.normals) slopes.assign(result.grid.values.size(), 0.0f);
    if (options_.near_field) {
      for (std::size_t t = 0; t < kNearFieldSteps.size(); ++t) {
        detail.near_field.push_back({.step = float(system.rows().steps()[t]),
                                     .mean = float(system.rows().mean_openness()[t]),
                                     .weight = Vec3f(0.0f)});
      }
    }
    const FitDamping damping = damping_for(samples);
    for (int c = 0; c < samples.channels; ++c) fit_channel(system, samples, damping, c, result, run);
    return result;
  }

 private:
  /// Noisy samples say less against the prior. Their mean variance counts and not each one's own: that is small where
  /// all of a sample's rays agreed by chance, and weighting by it would draw the light there.
  [[nodiscard]] FitDamping damping_for(const SampleSet& samples) const {
    const double noise = 1.0 + std::min(relative_noise(samples), kMostNoise) / (kMisfit * kMisfit);
    FitDamping damping{options_.value_prior * noise};
    std::size_t k = 1;
    if (options_.slopes) damping[k++] = options_.slope_prior * noise;
    for (; k < damping.size(); ++k) damping[k] = options_.normal_prior * noise;
    return damping;
  }

  /// What to add to the prior. Reading clamps light to between black and the brightest sample, and the fit is of what
  /// is read so: it ends where the weighted errors around a texel have no mean but what damping leaves. Light at its
  /// bounds is common (the open sky, a hole), and a fit without them is cut off on one side there. Each round's problem
  /// is linear: samples whose reading was clamped before hardly count as following it (nearly Newton's method).
  [[nodiscard]] FitVector solve(const FitSystem& system, const FitChannel& light, const FitDamping& damping,
                                const FitVector& prior, const ValueRange& bounds, const Run& run) const {
    FitVector x = system.zero();
    for (int round = 0; round < kRounds; ++round) {
      descend(system, damping, system.rest(light, prior, x, damping, bounds), options_.iterations, x, run);
    }
    return x;
  }

  /// Hestenes & Stiefel, "Methods of conjugate gradients for solving linear systems", 1952, with the texels' own blocks
  /// as preconditioner.
  static void descend(const FitSystem& system, const FitDamping& damping, FitRest rest, int iterations, FitVector& x,
                      const Run& run) {
    const FitBlocks inverse = system.inverse_blocks(damping, rest.weights);
    FitVector& residual = rest.gradient;
    FitVector step;
    FitVector image;
    FitVector scaled;
    std::vector<float> room;
    inverse.apply(residual, step, run);
    double error = product(residual, step, run);
    const double enough = 1e-8 * error;
    for (int i = 0; i < iterations && error > enough; ++i) {
      system.normal_product(step, damping, rest.weights, image, room);
      const double length = error / product(step, image, run);
      add_scaled(x, length, step, run);
      if (i + 1 == iterations) return;
      add_scaled(residual, -length, image, run);
      inverse.apply(residual, scaled, run);
      const double next = product(residual, scaled, run);
      add_to_scaled(step, next / error, scaled, run);
      error = next;
    }
  }

  /// A plain grid is not clamped when it is read.
  [[nodiscard]] static ValueRange read_between(const LightDetail& detail) {
    constexpr float kAny = std::numeric_limits<float>::infinity();
    return detail.empty() ? ValueRange{.low = -kAny, .high = kAny} : ValueRange{.low = 0.0f, .high = detail.ceiling};
  }

  void fit_channel(const FitSystem& system, const SampleSet& samples, const FitDamping& damping, int channel,
                   ResampledGrid& result, const Run& run) const {
    const auto channels = std::size_t(samples.channels);
    const auto first = std::size_t(channel);
    const FitChannel light{.first = samples.radiance.data() + first, .stride = channels};
    std::vector<float> coverage;
    const FitVector prior = system.prior(light, coverage);
    const FitVector x = solve(system, light, damping, prior, read_between(result.grid.detail), run);
    if (std::any_of(x.numbers.begin(), x.numbers.end(), [](float v) { return std::isnan(v); }))
      throw InvalidInput(
          "a fit of light is beyond floats where the volume's spacings, or its values, are too many orders of "
          "magnitude apart; allowed is another resampler, such as direct");
    LightDetail& detail = result.grid.detail;
    const FitTexels& texels = system.texels();
    const FitTerms& terms = system.terms();
    for (std::size_t n = 0; n < coverage.size(); ++n) {
      if (!(coverage[n] > 0.0f)) continue;
      const std::size_t t = texels.offsets()[n];
      const std::size_t at = t * channels + first;
      const auto number = [&](std::size_t k) { return x.numbers[k * texels.size() + n]; };
      result.lit[t] = 1;
      result.grid.values[at] = prior.numbers[n] + number(0);
      if (terms.slopes) detail.slopes[at] = slope_of(number(1) * texels.inverse_breadths()[n], texels.scale());
      for (std::size_t a = 0; terms.normals && a < 3; ++a)
        detail.normal_slopes[a][at] = number(terms.first_normal() + a);
    }
    for (std::size_t t = 0; t < detail.near_field.size(); ++t) {
      Vec3f& weight = detail.near_field[t].weight;
      if (channels == 1) weight = Vec3f(float(x.terms[t]));
      weight[channel] = float(x.terms[t]);
    }
  }

  /// Per unit of the volume's isovalues.
  [[nodiscard]] static float slope_of(float scaled, double scale) {
    const double slope = double(scaled) * scale;
    if (!(std::fabs(slope) <= double(std::numeric_limits<float>::max())))
      throw InvalidInput(
          fmt::format("light that changes by {:.3g} per unit of the volume's values is beyond a light file's floats; "
                      "allowed are resampler.slopes=false, or values in another unit",
                      slope));
    return float(slope);
  }

  /// Root mean square of what no texture can say of the light, of the light's own; a typical value on real volumes.
  static constexpr double kMisfit = 0.07;
  static constexpr double kMostNoise = 1e4;  ///< as of samples of whose variance nothing is known
  static constexpr int kRounds = 3;          ///< six gain 1 % more

  Options options_;
};

}  // namespace

void fit(Registry<Resampler>& registry) {
  registry.add<Fit>(
      "fit",
      "least-squares fit of the texels to scattered samples, as LightReader reads them: the most accurate; "
      "wants some 8 samples a texel, stratified");
}

}  // namespace isolux::backends
