#include "denoise.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lit_texels.h"
#include "texel_looks.h"
#include "wide/denoise_kernels.h"
#include "window_shares.h"

namespace isolux {
namespace {

using wide::LatticeSamples;

// Samples: whole shells where all texels are lit and as far apart along all axes; the light decides which is wide
// enough.
constexpr std::array<std::size_t, kWindowCount> kWindows = {57, 123, 203};
constexpr float kUnitLength = 2.0f;  // of normals and openness, grid spacings
constexpr float kRidge = 0.001f;
constexpr std::size_t kTouching = 19;  // a sample and those about it
constexpr std::size_t kAround = 27;    // where risks are averaged; more would blur the choice near edges
/// Samples farther apart in light than so many standard errors are of two sides of an edge, and not fitted together.
constexpr float kApart = 5.0f;
/// Standard error, in parts of the brightest sample, that is left alone: a tenth of a step of eight bits.
constexpr double kUnseen = 4e-4;
constexpr std::size_t kRowsABlock = 4;

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

/// Rows along x, or along the longest axis where there are too few texels along that to fill the lanes.
std::array<int, 3> axes_for(const Index3& texels, std::size_t lanes) {
  std::array<int, 3> axes{0, 1, 2};
  if (texels.x >= int(lanes)) return axes;
  const int longest = texels.y >= texels.z ? 1 : 2;
  if (texels[longest] > texels.x) std::swap(axes[0], axes[std::size_t(longest)]);
  return axes;
}

class Denoiser {
 public:
  Denoiser(const Volume& volume, const Lattice& texels, const SampleSet& samples, const Run& run)
      : channels_(std::size_t(samples.channels)),
        run_(run),
        kernels_(wide::denoise_kernels(channels_)),
        axes_(axes_for(texels.size, kernels_.lanes)),
        lit_(volume.lattice(), samples.sites, texels, axes_, run) {
    const Vec3 spacing = volume.lattice().frame.spacing();
    const Vec3 step = texels.frame.spacing() / std::cbrt(spacing.x * spacing.y * spacing.z);
    for (std::size_t a = 0; a < 3; ++a) all_.size[a] = texels.size[axes_[a]];
    all_.at = std::move(lit_.at);
    all_.channels = channels_;
    all_.stencil = wide::Stencil::of({step[axes_[0]], step[axes_[1]], step[axes_[2]]}, all_.size);
    look_at(volume, samples.sites, lit_.sites, run, all_);
  }

  /// `radiance` and `variance` are the samples', or parts of them.
  [[nodiscard]] std::vector<float> light(const std::vector<float>& radiance, const std::vector<float>& variance) {
    const float brightest = *std::max_element(radiance.begin(), radiance.end());
    unit_ = brightest > 0.0f ? std::ldexp(1.0f, -std::max(std::ilogb(brightest), -120)) : 1.0f;
    const double unseen = kUnseen * double(brightest * unit_);
    limits_.unseen = float(unseen * unseen);
    take_light(radiance, variance, lit_, unit_, all_);
    fit();
    multiply_rests();
    std::vector<float> texels(lit_.sites.size() * channels_);
    for_each(kAround, [&](std::size_t s, std::span<const std::uint32_t> around) {
      const bool known = is_known(around);
      const WindowShares shares = known ? WindowShares{} : shares_of(s, around);
      for (std::size_t c = 0; c < channels_; ++c) {
        double e = (known ? 1.0 : shares.back()) * double(this->radiance(s)[c]);
        for (std::size_t w = 0; w < kWindows.size(); ++w) e += shares[w] * double(smooth(w, s)[c]);
        texels[s * channels_ + c] = known ? float(e / double(unit_)) : std::max(0.0f, float(e / double(unit_)));
      }
    });
    std::vector<float> values(radiance.size());
    for (std::size_t s = 0; s < lit_.of_site.size(); ++s)
      std::copy_n(&texels[lit_.of_site[s] * channels_], channels_, &values[s * channels_]);
    return values;
  }

 private:
  [[nodiscard]] const float* radiance(std::size_t s) const { return all_.look(s) + LatticeSamples::kLight; }
  [[nodiscard]] const float* smooth(std::size_t window, std::size_t s) const {
    return &smooth_[(s * kWindows.size() + window) * channels_];
  }

  /// Calls row(y, z), in parallel.
  template <class Row>
  void for_rows(const Row& row) const {
    const auto height = std::size_t(all_.size[1]);
    parallel_blocks(height * std::size_t(all_.size[2]), kRowsABlock, run_, "denoise", [&](const Block& block) {
      for (std::size_t r = block.begin; r < block.end; ++r) row(int(r % height), int(r / height));
    });
  }

  /// Calls visit(sample, the `count` nearest of the stencil, itself the first).
  template <class Visit>
  void for_each(std::size_t count, const Visit& visit) const {
    for_rows([&](int y, int z) {
      std::vector<std::uint32_t> near(count);
      for (int x = 0; x < all_.size[0]; ++x) {
        const std::uint32_t s = all_.at[all_.row(y, z) + std::size_t(x)];
        if (s == LatticeSamples::kNone) continue;
        std::size_t found = 0;
        for (const wide::Stencil::Member& member : all_.stencil.members) {
          const std::array<int, 3> at{x + member.step[0], y + member.step[1], z + member.step[2]};
          if (at[0] < 0 || at[0] >= all_.size[0] || at[1] < 0 || at[1] >= all_.size[1] || at[2] < 0 ||
              at[2] >= all_.size[2])
            continue;
          const std::uint32_t other = all_.at[all_.row(at[1], at[2]) + std::size_t(at[0])];
          if (other == LatticeSamples::kNone) continue;
          near[found++] = other;
          if (found == count) break;
        }
        visit(s, std::span<const std::uint32_t>(near.data(), found));
      }
    });
  }

  /// Of two samples' light, by their normals.
  [[nodiscard]] float likeness(std::size_t a, std::size_t b) const {
    const float* const na = all_.look(a) + LatticeSamples::kNormal;
    const float* const nb = all_.look(b) + LatticeSamples::kNormal;
    const float cosine = na[0] * nb[0] + na[1] * nb[1] + na[2] * nb[2];
    return (cosine > 0.0f ? cosine * cosine : 0.0f) + 1e-6f;
  }

  /// Whether none of these samples has noise that could be seen.
  [[nodiscard]] bool is_known(std::span<const std::uint32_t> samples) const {
    return std::all_of(samples.begin(), samples.end(),
                       [&](std::uint32_t s) { return all_.look(s)[LatticeSamples::kVariance] <= limits_.unseen; });
  }

  void fit() {
    findings_.assign(lit_.sites.size(), {});
    smooth_.resize(lit_.sites.size() * kWindows.size() * channels_);
    for_rows([&](int y, int z) {
      std::array<wide::WindowFits, wide::DenoiseKernels::kMostLanes> fits;
      const auto row = std::span(all_.at).subspan(all_.row(y, z), std::size_t(all_.size[0]));
      for (std::size_t x = 0; x < row.size(); x += kernels_.lanes) {
        const auto here = row.subspan(x, std::min(kernels_.lanes, row.size() - x));
        const auto is_there = [](std::uint32_t s) { return s != LatticeSamples::kNone; };
        if (std::none_of(here.begin(), here.end(), is_there)) continue;
        kernels_.fit_row(all_, {int(x), y, z}, limits_, std::span(fits).first(here.size()));
        for (std::size_t n = 0; n < here.size(); ++n)
          if (is_there(here[n])) keep(here[n], fits[n]);
      }
    });
  }

  void keep(std::size_t s, const wide::WindowFits& fits) {
    for (std::size_t w = 0; w < kWindows.size(); ++w)
      std::copy_n(fits.is_fitted ? fits.light[w].data() : radiance(s), channels_,
                  &smooth_[(s * kWindows.size() + w) * channels_]);
    findings_[s].variance = all_.look(s)[LatticeSamples::kVariance];
    if (fits.is_fitted) find(s, fits);
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

  std::size_t channels_;
  const Run& run_;
  wide::DenoiseKernels kernels_;
  std::array<int, 3> axes_;  ///< of the texels, those of rows first
  LitTexels lit_;
  float unit_ = 1.0f;  ///< a power of two times which the brightest light is some 1 to 2
  LatticeSamples all_;
  std::vector<Findings> findings_;
  std::vector<float> smooth_;  ///< the windows' light; the channels of each, a sample after the other
  wide::WindowLimits limits_{.counts = kWindows, .apart = kApart, .unseen = 0.0f, .ridge = kRidge, .unit = kUnitLength};
};

}  // namespace

DenoisedLight denoised_light(const Volume& volume, const SampleSet& samples, const Lattice& texels, const Run& run) {
  Denoiser denoiser(volume, texels, samples, run);
  DenoisedLight light;
  if (samples.lamps.empty()) {
    light.rest = denoiser.light(samples.radiance, samples.variance);
    return light;
  }
  light.lamps = denoiser.light(samples.lamps, samples.lamps_variance);
  light.noisy_rest.resize(samples.radiance.size());
  std::vector<float> variance(samples.size());
  for (std::size_t v = 0; v < light.noisy_rest.size(); ++v)
    light.noisy_rest[v] = samples.radiance[v] - samples.lamps[v];
  for (std::size_t s = 0; s < variance.size(); ++s)
    variance[s] = std::max(0.0f, samples.variance[s] - samples.lamps_variance[s]);
  light.rest = denoiser.light(light.noisy_rest, variance);
  return light;
}

}  // namespace isolux
