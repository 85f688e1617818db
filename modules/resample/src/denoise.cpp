#include "denoise.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bin_order.h"
#include "near_field.h"
#include "sample_looks.h"
#include "shepard.h"
#include "wide/denoise_kernels.h"
#include "window_shares.h"

namespace isolux {
namespace {

// Samples, whole shells of a lattice each; the light decides which of them is wide enough.
constexpr std::array<std::size_t, kWindowCount> kWindows = {57, 123, 203};
static_assert(kWindows.back() <= wide::WindowLimits::kMost);
constexpr std::array<double, 3> kSteps = {1.0, 2.0, 4.0};  // of the openness, grid spacings
// Of the whole range of isovalues in grid steps: a coordinate of the fit, not of the search.
constexpr double kIsovalueLength = 2.0;
constexpr float kUnitLength = 2.0f;  // of normals and openness likewise
constexpr float kRidge = 0.001f;
constexpr std::size_t kTouching = 19;  // a sample and those about it
constexpr std::size_t kAround = 27;    // where risks are averaged; more would blur the choice near edges
constexpr float kOnALattice = 0.01f;   // of a bin's side: rounding, and no more
/// Part of the texels that are lit: where fewer are, a bin for each would be empty mostly.
constexpr double kSparse = 0.25;
/// Samples farther apart in light than so many standard errors are of two sides of an edge, and not fitted together.
constexpr float kApart = 5.0f;
/// Standard error, in parts of the brightest sample, that is left alone: a tenth of a step of eight bits.
constexpr double kUnseen = 4e-4;

/// What the windows of one sample say of it, to be averaged over the samples around: WindowsAround's numbers.
struct Findings {
  std::array<float, kWindowCount> apart{};
  std::array<float, kWindowCount> noise{1.0f, 1.0f, 1.0f};
  std::array<float, kWindowCount> noise_apart{};
  float left = 0.0f;
  float follows = 1.0f;
  float product = 0.0f;
  float variance = 0.0f;
};

class Denoiser {
 public:
  /// `radiance` and `variance` are the samples', or parts of them.
  Denoiser(const Volume& volume, const Lattice& texels, const SampleSet& samples, const std::vector<float>& radiance,
           const std::vector<float>& variance, const Run& run)
      : sites_(samples.sites),
        radiance_(radiance),
        variance_(variance),
        channels_(std::size_t(samples.channels)),
        run_(run),
        kernels_(wide::denoise_kernels(channels_)) {
    const ShepardSpace space(volume, samples,
                             ShepardOptions{.k = int(kWindows.back()), .isovalue_length = kIsovalueLength});
    // A bin for each texel gives a lattice its stencil; few samples are found sooner in larger ones.
    const double lit = double(samples.size()) / double(texels.count());
    BinOrder bins(space.samples(), space.far_corner(), lit > kSparse && lit < 1.0 ? lit : 1.0);
    order_ = std::move(bins.points);
    all_.bins = bins.size;
    all_.starts = std::move(bins.starts);
    all_.side = bins.side;
    all_.channels = channels_;
    all_.looks.resize(order_.size() * all_.stride());
    for (std::size_t s = 0; s < order_.size(); ++s)
      for (std::size_t a = 0; a < wide::BinnedSamples::kNormal; ++a)
        all_.look(s)[a] = space.samples()[order_[s]].x[a] / bins.side;
    for (std::size_t a = 0; a < 3; ++a) {
      all_.places[a].resize(order_.size() + wide::BinnedSamples::kPastTheEnd);
      for (std::size_t s = 0; s < order_.size(); ++s) all_.places[a][s] = all_.look(s)[a];
    }
    if (are_on_a_lattice()) all_.stencil = wide::Stencil::of(all_.bins, kWindows.back());
    const float brightest = *std::max_element(radiance.begin(), radiance.end());
    if (brightest > 0.0f) unit_ = std::ldexp(1.0f, -std::max(std::ilogb(brightest), -120));
    look(volume);
    const double unseen = kUnseen * double(brightest * unit_);
    limits_.unseen = float(unseen * unseen);
  }

  [[nodiscard]] std::vector<float> light() {
    fit();
    multiply_rests();
    std::vector<float> values = radiance_;
    for_each(kAround, [&](std::size_t s, std::span<const std::uint32_t> around) {
      if (is_known(around)) return;
      const WindowShares shares = shares_of(s, around);
      for (std::size_t c = 0; c < channels_; ++c) {
        double e = shares.back() * double(radiance(s)[c]);
        for (std::size_t w = 0; w < kWindows.size(); ++w) e += shares[w] * double(smooth(w, s)[c]);
        values[order_[s] * channels_ + c] = std::max(0.0f, float(e / double(unit_)));
      }
    });
    return values;
  }

 private:
  /// Whether all samples are at the same place in their bins, and alone.
  [[nodiscard]] bool are_on_a_lattice() const {
    for (std::size_t b = 0; b + 1 < all_.starts.size(); ++b)
      if (all_.starts[b + 1] - all_.starts[b] > 1) return false;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::span<const float> places(all_.places[a].data(), order_.size());
      const float first = places[0] - std::floor(places[0]);
      if (!std::all_of(places.begin(), places.end(),
                       [&](float at) { return std::fabs(at - std::floor(at) - first) < kOnALattice; }))
        return false;
    }
    return true;
  }

  /// Copies the samples in their order, with the openness in front of each.
  void look(const Volume& volume) {
    const NearField near_field(volume);
    const double outwards = near_field.outwards(sites_);
    parallel_blocks(order_.size(), 512, run_, "", [&](const Block& block) {
      SampleLooks looks(near_field, sites_);
      looks.look(std::span(order_).subspan(block.begin, block.end - block.begin));
      for (std::size_t t = 0; t < kSteps.size(); ++t) {
        looks.find_openness(outwards * kSteps[t]);
        for (std::size_t s = block.begin; s < block.end; ++s)
          all_.look(s)[wide::BinnedSamples::kOpenness + t] = looks.openness(s - block.begin);
      }
      for (std::size_t s = block.begin; s < block.end; ++s) {
        float* const look = all_.look(s);
        const Vec3f& normal = sites_.normals[order_[s]];
        for (int a = 0; a < 3; ++a) look[wide::BinnedSamples::kNormal + std::size_t(a)] = normal[a];
        look[wide::BinnedSamples::kVariance] = variance_[order_[s]] * unit_ * unit_;
        const float* const light = &radiance_[order_[s] * channels_];
        std::transform(light, light + channels_, look + wide::BinnedSamples::kLight,
                       [&](float e) { return e * unit_; });
      }
    });
  }

  [[nodiscard]] const float* radiance(std::size_t s) const { return all_.look(s) + wide::BinnedSamples::kLight; }
  [[nodiscard]] const float* smooth(std::size_t window, std::size_t s) const {
    return &smooth_[(s * kWindows.size() + window) * channels_];
  }

  template <class Visit>
  void for_each(std::size_t count, const Visit& visit) const {
    parallel_blocks(order_.size(), 512, run_, "denoise", [&](const Block& block) {
      wide::NearSamples near;
      for (std::size_t s = block.begin; s < block.end; ++s) {
        kernels_.nearest(all_, s, count, near);
        visit(s, std::span<const std::uint32_t>(near.samples.data(), near.count));
      }
    });
  }

  /// Of two samples' light, by their normals.
  [[nodiscard]] float likeness(std::size_t a, std::size_t b) const {
    const float* const na = all_.look(a) + wide::BinnedSamples::kNormal;
    const float* const nb = all_.look(b) + wide::BinnedSamples::kNormal;
    const float cosine = na[0] * nb[0] + na[1] * nb[1] + na[2] * nb[2];
    return (cosine > 0.0f ? cosine * cosine : 0.0f) + 1e-6f;
  }

  /// Whether none of these samples has noise that could be seen.
  [[nodiscard]] bool is_known(std::span<const std::uint32_t> samples) const {
    return std::all_of(samples.begin(), samples.end(),
                       [&](std::uint32_t s) { return all_.look(s)[wide::BinnedSamples::kVariance] <= limits_.unseen; });
  }

  void fit() {
    findings_.resize(order_.size());
    smooth_.resize(order_.size() * kWindows.size() * channels_);
    parallel_blocks(order_.size(), 512, run_, "denoise", [&](const Block& block) {
      wide::NearSamples near;
      wide::WindowFits fits;
      for (std::size_t s = block.begin; s < block.end; ++s) {
        kernels_.nearest(all_, s, kWindows.back(), near);
        const bool fitted = kernels_.fit(all_, s, near, limits_, fits);
        for (std::size_t w = 0; w < kWindows.size(); ++w)
          std::copy_n(fitted ? fits.light[w].data() : radiance(s), channels_,
                      &smooth_[(s * kWindows.size() + w) * channels_]);
        findings_[s].variance = all_.look(s)[wide::BinnedSamples::kVariance];
        if (fitted) find(s, fits);
      }
    });
  }

  void find(std::size_t s, const wide::WindowFits& fits) {
    Findings& found = findings_[s];
    found.noise = fits.noise;
    found.noise_apart = fits.noise_apart;
    found.follows = fits.follows;
    for (std::size_t c = 0; c < channels_; ++c) {
      const float part = 1.0f / float(channels_);
      found.left += part * rest(s, c) * rest(s, c);
      for (std::size_t w = 1; w < kWindows.size(); ++w) {
        const float apart = smooth(w, s)[c] - smooth(0, s)[c];
        found.apart[w] += part * apart * apart;
      }
    }
  }

  /// What the narrowest fit leaves of a sample.
  [[nodiscard]] float rest(std::size_t s, std::size_t channel) const {
    return radiance(s)[channel] - smooth(0, s)[channel];
  }

  /// What the narrowest fit leaves of each sample, times what it leaves of those about it: the noise of two samples has
  /// nothing in common, what a fit misses has.
  void multiply_rests() {
    for_each(kTouching, [&](std::size_t s, std::span<const std::uint32_t> touching) {
      float weights = 0.0f;
      float sum = 0.0f;
      for (const std::uint32_t other : touching) {
        if (other == s) continue;
        const float w = likeness(s, other);
        weights += w;
        for (std::size_t c = 0; c < channels_; ++c) sum += w * rest(s, c) * rest(other, c);
      }
      findings_[s].product = weights > 0.0f ? sum / (weights * float(channels_)) : 0.0f;
    });
  }

  [[nodiscard]] WindowShares shares_of(std::size_t s, std::span<const std::uint32_t> samples) const {
    Findings sums{.noise = {}, .follows = 0.0f};
    float weights = 0.0f;
    for (const std::uint32_t other : samples) {
      const float w = likeness(s, other);
      const Findings& found = findings_[other];
      weights += w;
      for (std::size_t k = 0; k < kWindows.size(); ++k) {
        sums.apart[k] += w * found.apart[k];
        sums.noise[k] += w * found.noise[k];
        sums.noise_apart[k] += w * found.noise_apart[k];
      }
      sums.left += w * found.left;
      sums.follows += w * found.follows;
      sums.product += w * found.product;
      sums.variance += w * found.variance;
    }
    const double part = 1.0 / double(weights);
    WindowsAround around{.left = part * double(sums.left),
                         .follows = part * double(sums.follows),
                         .product = part * double(sums.product),
                         .variance = part * double(sums.variance)};
    for (std::size_t k = 0; k < kWindows.size(); ++k) {
      around.windows[k] = {.apart = part * double(sums.apart[k]),
                           .noise = part * double(sums.noise[k]),
                           .noise_apart = part * double(sums.noise_apart[k])};
    }
    return window_shares(around);
  }

  const Sites& sites_;
  const std::vector<float>& radiance_;
  const std::vector<float>& variance_;
  std::size_t channels_;
  const Run& run_;
  wide::DenoiseKernels kernels_;
  float unit_ = 1.0f;                 ///< a power of two times which the brightest light is some 1 to 2
  std::vector<std::uint32_t> order_;  ///< of the given samples; all that follows is in the order of bins
  wide::BinnedSamples all_;
  std::vector<Findings> findings_;
  std::vector<float> smooth_;  ///< the windows' light; the channels of each, a sample after the other
  wide::WindowLimits limits_{.counts = kWindows, .apart = kApart, .unseen = 0.0f, .ridge = kRidge, .unit = kUnitLength};
};

}  // namespace

DenoisedLight denoised_light(const Volume& volume, const SampleSet& samples, const Lattice& texels, const Run& run) {
  DenoisedLight light;
  if (samples.lamps.empty()) {
    light.rest = Denoiser(volume, texels, samples, samples.radiance, samples.variance, run).light();
    return light;
  }
  light.lamps = Denoiser(volume, texels, samples, samples.lamps, samples.lamps_variance, run).light();
  light.noisy_rest.resize(samples.radiance.size());
  std::vector<float> variance(samples.size());
  for (std::size_t v = 0; v < light.noisy_rest.size(); ++v)
    light.noisy_rest[v] = samples.radiance[v] - samples.lamps[v];
  for (std::size_t s = 0; s < variance.size(); ++s)
    variance[s] = std::max(0.0f, samples.variance[s] - samples.lamps_variance[s]);
  light.rest = Denoiser(volume, texels, samples, light.noisy_rest, variance, run).light();
  return light;
}

}  // namespace isolux
