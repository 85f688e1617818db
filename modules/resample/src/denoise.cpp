#include "denoise.h"

#include <isolux/core/parallel.h>
#include <isolux/core/release.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "local_fit.h"
#include "near_field.h"
#include "sample_bins.h"
#include "shepard.h"
#include "window_shares.h"

namespace isolux {
namespace {

// Samples; the light decides which of them is wide enough.
constexpr std::array<std::size_t, kWindowCount> kWindows = {57, 120, 200};
constexpr std::size_t kCoordinates = 10;                   // place, isovalue, normal, openness
constexpr std::array<double, 3> kSteps = {1.0, 2.0, 4.0};  // of the openness, grid spacings
// Of the whole range of isovalues in grid steps: a coordinate of the fit, hardly of the search.
constexpr double kIsovalueLength = 2.0;
constexpr double kUnitLength = 2.0;  // of normals and openness likewise
constexpr double kRidge = 0.001;
constexpr std::size_t kTouching = 13;  // a sample and those about it
constexpr std::size_t kAround = 20;    // where risks are averaged; more would blur the choice near edges
/// Samples farther apart in light than so many standard errors are of two sides of an edge, and not fitted together.
constexpr double kApart = 5.0;
/// Standard error, in parts of the brightest sample, that is left alone: a tenth of a step of eight bits.
constexpr double kUnseen = 4e-4;

class Denoiser {
 public:
  Denoiser(const Volume& volume, const SampleSet& samples, const Run& run)
      : samples_(samples),
        channels_(std::size_t(samples.channels)),
        run_(run),
        space_(volume, samples, ShepardOptions{.k = int(kWindows.back()), .isovalue_length = kIsovalueLength}),
        bins_(space_.samples(), space_.far_corner(), 1.0),
        openness_(samples.size()) {
    const float brightest = *std::max_element(samples.radiance.begin(), samples.radiance.end());
    unseen_ = float(std::pow(kUnseen * double(brightest), 2.0));
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
    std::vector<float> values = samples_.radiance;
    const std::vector<float> products = products_of_rests();
    for_each(kAround, [&](std::size_t s, const std::vector<Neighbour>& found) {
      if (is_known(found)) return;
      const WindowShares shares = shares_of(s, found, products);
      for (std::size_t v = s * channels_; v < (s + 1) * channels_; ++v) {
        double e = shares.back() * double(samples_.radiance[v]);
        for (std::size_t w = 0; w < kWindows.size(); ++w) e += shares[w] * double(windows_[w].smooth[v]);
        values[v] = std::max(0.0f, float(e));
      }
    });
    return values;
  }

 private:
  using Coordinates = LocalFit<kCoordinates>::Coordinates;

  /// Light fitted in windows of one width, and one number a sample of how.
  struct Window {
    std::vector<float> smooth;
    std::vector<float> follows;      ///< the part of a sample in its own smooth light
    std::vector<float> noise;        ///< variance of the smooth light where independent samples have one of 1
    std::vector<float> noise_apart;  ///< likewise, of its difference from the narrowest window's
  };

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

  [[nodiscard]] Coordinates coordinates(std::size_t of, std::size_t from) const {
    const Sites& sites = samples_.sites;
    const Vec3 place = Vec3(sites.positions[of]) - Vec3(sites.positions[from]);
    const Vec3 turn = kUnitLength * (Vec3(sites.normals[of]) - Vec3(sites.normals[from]));
    const double isovalue = double(space_.samples()[of].x[3]) - double(space_.samples()[from].x[3]);
    Coordinates at{place.x, place.y, place.z, isovalue, turn.x, turn.y, turn.z};
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

  /// Whether none of these samples has noise that could be seen.
  [[nodiscard]] bool is_known(const std::vector<Neighbour>& found) const {
    return std::all_of(found.begin(), found.end(),
                       [&](const Neighbour& n) { return samples_.variance[n.sample()] <= unseen_; });
  }

  void fit() {
    for (Window& window : windows_) {
      window.smooth = samples_.radiance;
      window.follows.assign(samples_.size(), 1.0f);
      window.noise.assign(samples_.size(), 1.0f);
      window.noise_apart.assign(samples_.size(), 0.0f);
    }
    for_each(kWindows.back(), [&](std::size_t s, const std::vector<Neighbour>& found) {
      if (is_known(found)) return;
      static thread_local Members members;
      members.narrowest.clear();
      const double apart = kApart * kApart * variance_around(s, found) + kNoError;
      for (std::size_t w = 0; w < kWindows.size(); ++w) fit(w, s, found, apart, members);
    });
  }

  /// Of one window.
  struct Members {
    std::vector<double> weights;
    std::vector<Coordinates> coordinates;
    std::vector<double> narrowest;  ///< influence on the narrowest window's light
  };

  void fit(std::size_t w, std::size_t s, const std::vector<Neighbour>& found, double apart, Members& members) {
    Window& window = windows_[w];
    const std::size_t count = std::min(kWindows[w], found.size());
    const double reach = 1.0001 * double(found[count - 1].reach());
    LocalFit<kCoordinates> fit;
    members.weights.clear();
    members.coordinates.clear();
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t other = found[n].sample();
      const double ratio = reach > 0.0 ? std::sqrt(double(found[n].reach()) / reach) : 0.0;
      members.weights.push_back((1.0 - 0.75 * ratio) * likeness(s, other) * same_side(s, other, apart));
      members.coordinates.push_back(coordinates(other, s));
      fit.add(members.weights[n], members.coordinates[n], &samples_.radiance[other * channels_], channels_);
    }
    const auto influence = fit.at_origin(kRidge, &window.smooth[s * channels_], channels_);
    double noise = 0.0;
    double noise_apart = 0.0;
    for (std::size_t n = 0; n < count; ++n) {
      const double part = members.weights[n] * influence.of(members.coordinates[n]);
      if (w == 0) members.narrowest.push_back(part);
      const double more = part - (n < members.narrowest.size() ? members.narrowest[n] : 0.0);
      noise += part * part;
      noise_apart += more * more;
    }
    window.follows[s] = float(std::min(1.0, influence.there));
    window.noise[s] = float(noise);
    window.noise_apart[s] = float(noise_apart);
  }

  [[nodiscard]] double rest(std::size_t window, std::size_t v) const {
    return double(samples_.radiance[v]) - double(windows_[window].smooth[v]);
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

  [[nodiscard]] WindowShares shares_of(std::size_t s, const std::vector<Neighbour>& found,
                                       const std::vector<float>& products) const {
    WindowsAround around;
    double weights = 0.0;
    for (const Neighbour& n : found) weights += likeness(s, n.sample());
    for (const Neighbour& n : found) {
      const double w = likeness(s, n.sample()) / weights;
      around.product += w * double(products[n.sample()]);
      for (std::size_t k = 0; k < kWindows.size(); ++k) add(k, n.sample(), w, around.windows[k]);
    }
    around.variance = variance_around(s, found);
    return window_shares(around);
  }

  void add(std::size_t k, std::size_t sample, double weight, WindowAround& around) const {
    const Window& window = windows_[k];
    for (std::size_t v = sample * channels_; v < (sample + 1) * channels_; ++v) {
      const double left = rest(k, v);
      const double apart = double(window.smooth[v]) - double(windows_[0].smooth[v]);
      around.left += weight * left * left / double(channels_);
      around.apart += weight * apart * apart / double(channels_);
    }
    around.follows += weight * double(window.follows[sample]);
    around.noise += weight * double(window.noise[sample]);
    around.noise_apart += weight * double(window.noise_apart[sample]);
  }

  const SampleSet& samples_;
  std::size_t channels_;
  const Run& run_;
  ShepardSpace space_;
  SampleBins bins_;
  std::vector<std::array<float, kSteps.size()>> openness_;
  std::array<Window, kWindows.size()> windows_;
  float unseen_ = 0.0f;  ///< variance of kUnseen
};

}  // namespace

SampleSet denoised(const Volume& volume, const SampleSet& samples, const Run& run) {
  SampleSet result = samples;
  if (samples.lamps.empty()) {
    result.radiance = Denoiser(volume, samples, run).light();
    return result;
  }
  release(result.lamps);
  release(result.lamps_variance);
  result.radiance = samples.lamps;
  result.variance = samples.lamps_variance;
  const std::vector<float> lamps = Denoiser(volume, result, run).light();
  for (std::size_t v = 0; v < lamps.size(); ++v) result.radiance[v] = samples.radiance[v] - samples.lamps[v];
  for (std::size_t s = 0; s < samples.size(); ++s)
    result.variance[s] = std::max(0.0f, samples.variance[s] - samples.lamps_variance[s]);
  result.radiance = Denoiser(volume, result, run).light();
  for (std::size_t v = 0; v < lamps.size(); ++v) result.radiance[v] += lamps[v];
  result.variance = samples.variance;
  return result;
}

}  // namespace isolux
