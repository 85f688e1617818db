#include "denoise.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "local_fit.h"
#include "near_field.h"
#include "sample_bins.h"
#include "shepard.h"

namespace isolux {
namespace {

// Samples; the light decides which of them is wide enough.
constexpr std::array<std::size_t, 3> kWindows = {57, 120, 200};
constexpr std::size_t kCoordinates = 10;                   // place, isovalue, normal, openness
constexpr std::array<double, 3> kSteps = {1.0, 2.0, 4.0};  // of the openness, grid spacings
// Of the whole range of isovalues in grid steps: a coordinate of the fit, hardly of the search.
constexpr double kIsovalueLength = 2.0;
constexpr double kUnitLength = 2.0;  // of normals and openness likewise
constexpr double kRidge = 0.001;
constexpr std::size_t kTouching = 13;  // a sample and those about it
constexpr std::size_t kAround = 20;    // where risks are averaged; more would blur the choice near edges
/// A site's own variance is known within this factor: on the whole it is right, but few rays that agree by chance, or
/// because of where their strata lie, say less than there is.
constexpr double kVarianceFactor = 4.0;
/// Samples farther apart in light than so many standard errors are of two sides of an edge, and not fitted together.
constexpr double kApart = 5.0;
/// What reading between texels leaves of the noise of their own rays, which it averages (30 % of independent noise at
/// random points, less of nets), and of what a fit misses or of its noise, which neighbours share, it leaves all.
constexpr double kReadNoise = 0.25;

class Denoiser {
 public:
  Denoiser(const Volume& volume, const SampleSet& samples, const Run& run)
      : samples_(samples),
        channels_(std::size_t(samples.channels)),
        run_(run),
        space_(volume, samples, ShepardOptions{.k = int(kWindows.back()), .isovalue_length = kIsovalueLength}),
        bins_(space_.samples(), space_.far_corner(), 1.0),
        openness_(samples.size()) {
    const NearField near_field(volume);
    const double outwards = near_field.outwards(samples.sites);
    parallel_blocks(samples.size(), 512, run, "", [&](const Block& block) {
      for (std::size_t s = block.begin; s < block.end; ++s) {
        const Vec3 at(samples.sites.positions[s]);
        const NearField::Ahead ahead = near_field.ahead(at);
        for (std::size_t t = 0; t < kSteps.size(); ++t) {
          openness_[s][t] = near_field.openness(at, ahead, double(samples.sites.isovalues[s]), outwards * kSteps[t]);
        }
      }
    });
  }

  [[nodiscard]] std::vector<float> light() {
    fit();
    std::vector<float> values(samples_.radiance.size());
    const std::vector<float> products = products_of_rests();
    for_each(kAround, [&](std::size_t s, const std::vector<Neighbour>& found) {
      const std::array<double, kWindows.size() + 1> shares = shares_of(s, found, products);
      for (std::size_t v = s * channels_; v < (s + 1) * channels_; ++v) {
        double e = shares.back() * double(samples_.radiance[v]);
        for (std::size_t w = 0; w < kWindows.size(); ++w) e += shares[w] * double(smooth_[w][v]);
        values[v] = std::max(0.0f, float(e));
      }
    });
    return values;
  }

 private:
  template <class Visit>
  void for_each(std::size_t count, const Visit& visit) const {
    parallel_blocks(samples_.size(), 512, run_, "denoise", [&](const Block& block) {
      std::vector<Neighbour> found;
      for (std::size_t s = block.begin; s < block.end; ++s) {
        bins_.search<EuclideanMetric>(space_.samples()[s], {.count = count}, found);
        visit(s, found);
      }
    });
  }

  /// Of two samples' light, by their normals.
  [[nodiscard]] double likeness(std::size_t a, std::size_t b) const {
    const double cosine = double(glm::dot(samples_.sites.normals[a], samples_.sites.normals[b]));
    return (cosine > 0.0 ? cosine * cosine : 0.0) + 1e-6;
  }

  [[nodiscard]] LocalFit<kCoordinates>::Coordinates coordinates(std::size_t of, std::size_t from) const {
    const Sites& sites = samples_.sites;
    const Vec3 place = Vec3(sites.positions[of]) - Vec3(sites.positions[from]);
    const Vec3 turn = kUnitLength * (Vec3(sites.normals[of]) - Vec3(sites.normals[from]));
    const double isovalue = double(space_.samples()[of].x[3]) - double(space_.samples()[from].x[3]);
    LocalFit<kCoordinates>::Coordinates at{place.x, place.y, place.z, isovalue, turn.x, turn.y, turn.z};
    for (std::size_t t = 0; t < kSteps.size(); ++t)
      at[7 + t] = kUnitLength * double(openness_[of][t] - openness_[from][t]);
    return at;
  }

  /// Mean variance of like samples.
  [[nodiscard]] double variance_around(std::size_t s, const std::vector<Neighbour>& found) const {
    double weights = 0.0;
    double variance = 0.0;
    for (const Neighbour& n : found) {
      const double w = likeness(s, n.sample());
      weights += w;
      variance += w * double(samples_.variance[n.sample()]);
    }
    return variance / weights;
  }

  /// 1 where two samples differ by their noise at most, falling to 0 where by more than `apart`, a squared difference.
  /// Steps of light so end a window that place and normals do not.
  [[nodiscard]] double same_side(std::size_t a, std::size_t b, double apart) const {
    double squares = 0.0;
    for (std::size_t c = 0; c < channels_; ++c) {
      const double d = double(samples_.radiance[a * channels_ + c]) - double(samples_.radiance[b * channels_ + c]);
      squares += d * d / double(channels_);
    }
    const double ratio = squares / apart;
    return 1.0 / (1.0 + ratio * ratio * ratio);
  }

  void fit() {
    for (std::size_t w = 0; w < kWindows.size(); ++w) {
      smooth_[w].resize(samples_.radiance.size());
      follows_[w].resize(samples_.size());
    }
    for_each(kWindows.back(), [&](std::size_t s, const std::vector<Neighbour>& found) {
      const double apart = kApart * kApart * variance_around(s, found) + kNothing;
      for (std::size_t w = 0; w < kWindows.size(); ++w) {
        const std::size_t count = std::min(kWindows[w], found.size());
        const double reach = 1.0001 * double(found[count - 1].reach());
        LocalFit<kCoordinates> fit;
        for (std::size_t n = 0; n < count; ++n) {
          const std::size_t other = found[n].sample();
          const double ratio = reach > 0.0 ? std::sqrt(double(found[n].reach()) / reach) : 0.0;
          const double weight = (1.0 - 0.75 * ratio) * likeness(s, other) * same_side(s, other, apart);
          fit.add(weight, coordinates(other, s), &samples_.radiance[other * channels_], channels_);
        }
        follows_[w][s] = float(std::min(1.0, fit.at_origin(kRidge, &smooth_[w][s * channels_], channels_)));
      }
    });
  }

  [[nodiscard]] double rest(std::size_t window, std::size_t v) const {
    return double(samples_.radiance[v]) - double(smooth_[window][v]);
  }

  /// What the narrowest fit leaves of each sample, times what it leaves of those about it: the noise of two samples has
  /// nothing in common, what a fit misses has.
  [[nodiscard]] std::vector<float> products_of_rests() const {
    std::vector<float> products(samples_.size());
    for_each(kTouching, [&](std::size_t s, const std::vector<Neighbour>& found) {
      double weights = 0.0;
      double sum = 0.0;
      for (const Neighbour& n : found) {
        if (n.sample() == s) continue;
        const double w = likeness(s, n.sample());
        weights += w;
        for (std::size_t c = 0; c < channels_; ++c)
          sum += w * rest(0, s * channels_ + c) * rest(0, n.sample() * channels_ + c) / double(channels_);
      }
      products[s] = weights > 0.0 ? float(sum / weights) : 0.0f;
    });
    return products;
  }

  /// Of each window's light, and of the samples' own last: by the inverse sixth powers of their estimated mean squared
  /// errors.
  [[nodiscard]] std::array<double, kWindows.size() + 1> shares_of(std::size_t s, const std::vector<Neighbour>& found,
                                                                  const std::vector<float>& products) const {
    std::array<double, kWindows.size()> spread{};
    std::array<double, kWindows.size()> follows{};
    double weights = 0.0;
    double missed = 0.0;
    for (const Neighbour& n : found) {
      const double w = likeness(s, n.sample());
      weights += w;
      missed += w * double(products[n.sample()]);
      for (std::size_t k = 0; k < kWindows.size(); ++k) {
        follows[k] += w * double(follows_[k][n.sample()]);
        for (std::size_t c = 0; c < channels_; ++c) {
          const double left = rest(k, n.sample() * channels_ + c);
          spread[k] += w * left * left / double(channels_);
        }
      }
    }
    const double seen = (spread[0] - std::max(0.0, missed)) / (weights - std::min(follows[0], 0.9 * weights));
    const double noise = std::clamp(seen, 0.0, kVarianceFactor * variance_around(s, found));
    std::array<double, kWindows.size() + 1> shares{};
    double sum = 0.0;
    for (std::size_t k = 0; k <= kWindows.size(); ++k) {
      double risk = kReadNoise * noise;
      if (k < kWindows.size()) {
        const double followed = follows[k] / weights;
        risk = std::max(spread[k] / weights - noise * (1.0 - 2.0 * followed), noise * followed);
      }
      shares[k] = std::pow(risk + kNothing, -6.0);
      sum += shares[k];
    }
    for (double& share : shares) share /= sum;
    return shares;
  }

  static constexpr double kNothing = 1e-14;  ///< an error of 1e-7, that of floats

  const SampleSet& samples_;
  std::size_t channels_;
  const Run& run_;
  ShepardSpace space_;
  SampleBins bins_;
  std::vector<std::array<float, kSteps.size()>> openness_;
  std::array<std::vector<float>, kWindows.size()> smooth_;   ///< by window
  std::array<std::vector<float>, kWindows.size()> follows_;  ///< the part of a sample in its own smooth light
};

}  // namespace

SampleSet denoised(const Volume& volume, const SampleSet& samples, const Run& run) {
  SampleSet result = samples;
  result.radiance = Denoiser(volume, samples, run).light();
  return result;
}

}  // namespace isolux
