#include "denoise.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "lit_texels.h"
#include "sample_window.h"
#include "texel_looks.h"
#include "wide/denoise_kernels.h"
#include "window_findings.h"
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
  /// Texels are denoised so many at a time, in whole layers: of those far from them nothing is held.
  Denoiser(const Volume& volume, const Lattice& texels, const SampleSet& samples, std::size_t texels_a_step,
           const Run& run)
      : channels_(std::size_t(samples.channels)),
        run_(run),
        kernels_(wide::denoise_kernels(channels_)),
        axes_(axes_for(texels.size, kernels_.lanes)),
        lit_(volume.lattice(), samples.sites, texels, axes_, run),
        looks_(volume, samples.sites, lit_) {
    const Vec3 spacing = volume.lattice().frame.spacing();
    const Vec3 step = texels.frame.spacing() / std::cbrt(spacing.x * spacing.y * spacing.z);
    for (std::size_t a = 0; a < 3; ++a) all_.size[a] = texels.size[axes_[a]];
    all_.at = std::move(lit_.at);
    all_.channels = channels_;
    all_.stencil = wide::Stencil::of({step[axes_[0]], step[axes_[1]], step[axes_[2]]}, all_.size);
    for (const wide::Stencil::Row& row : all_.stencil.rows) reach_ = std::max(reach_, row.z);
    const std::size_t layers = texels_a_step / (std::size_t(all_.size[0]) * std::size_t(all_.size[1]));
    layers_a_step_ = int(std::clamp(layers, std::size_t(1), std::size_t(all_.size[2])));
  }

  /// `radiance` and `variance` are the samples', or parts of them.
  [[nodiscard]] std::vector<float> light(const std::vector<float>& radiance, const std::vector<float>& variance) {
    const float brightest = *std::max_element(radiance.begin(), radiance.end());
    unit_ = brightest > 0.0f ? std::ldexp(1.0f, -std::max(std::ilogb(brightest), -120)) : 1.0f;
    const double unseen = kUnseen * double(brightest * unit_);
    limits_.unseen = float(unseen * unseen);
    const NoisyLight noisy(radiance, variance, lit_, channels_, unit_);
    std::vector<float> values(radiance.size());  // of each texel at its first site
    const int depth = all_.size[2];
    make_room(layers_a_step_ + 4 * reach_);
    // Each step asks for layers of the one before it, as far away as the stencil reaches.
    int held = 0;
    int fitted = 0;
    int multiplied = 0;
    for (int done = 0; done < depth;) {
      const int next = std::min(depth, done + layers_a_step_);
      const auto ahead = [&](int steps) { return std::min(depth, next + steps * reach_); };
      hold(std::exchange(held, ahead(3)), ahead(3), noisy);
      const Run part = part_of(run_, double(fitted) / depth, double(ahead(2)) / depth);
      fit(std::exchange(fitted, ahead(2)), ahead(2), part);
      multiply_rests(std::exchange(multiplied, ahead(1)), ahead(1));
      share(done, next, values);
      let_go_before(next - reach_);
      done = next;
    }
    for (std::size_t s = 0; s < lit_.of_site.size(); ++s)
      std::copy_n(&values[lit_.sites[lit_.of_site[s]] * channels_], channels_, &values[s * channels_]);
    return values;
  }

 private:
  [[nodiscard]] const float* radiance(std::size_t s) const { return all_.look(s) + LatticeSamples::kLight; }
  [[nodiscard]] const float* smooth(std::size_t window, std::size_t s) const {
    return smooth_.of(s) + window * channels_;
  }

  /// For the samples of so many layers next to each other, wherever.
  void make_room(int layers) {
    std::size_t most = 0;
    const std::size_t all = lit_.layers.size() - 1;
    for (std::size_t z = 0; z < all; ++z)
      most = std::max<std::size_t>(most, lit_.layers[std::min(z + std::size_t(layers), all)] - lit_.layers[z]);
    all_.looks = SampleWindow<float>(LatticeSamples::stride(channels_), most);
    findings_ = SampleWindow<WindowFindings>(1, most);
    smooth_ = SampleWindow<float>(kWindows.size() * channels_, most);
  }
  /// Begins to hold the samples of layers.
  void hold(int begin, int end, const NoisyLight& light) {
    const std::size_t first = lit_.layers[std::size_t(begin)];
    const std::size_t last = lit_.layers[std::size_t(end)];
    all_.looks.hold_until(last);
    findings_.hold_until(last);
    smooth_.hold_until(last);
    looks_.write(first, last, run_, all_);
    light.write(first, last, run_, all_);
  }
  void let_go_before(int layer) {
    if (layer <= 0) return;
    const std::size_t first = lit_.layers[std::size_t(layer)];
    all_.looks.let_go_before(first);
    findings_.let_go_before(first);
    smooth_.let_go_before(first);
  }

  /// Calls row(y, z), in parallel, for the rows of some layers.
  template <class Row>
  void for_rows(int begin, int end, const Run& run, std::string_view stage, const Row& row) const {
    const auto height = std::size_t(all_.size[1]);
    const auto first = height * std::size_t(begin);
    parallel_blocks(height * std::size_t(end - begin), kRowsABlock, run, stage, [&](const Block& block) {
      for (std::size_t r = first + block.begin; r < first + block.end; ++r) row(int(r % height), int(r / height));
    });
  }

  /// Calls visit(sample, the `count` nearest of the stencil, itself the first) for the samples of some layers.
  template <class Visit>
  void for_each(int begin, int end, std::size_t count, const Visit& visit) const {
    for_rows(begin, end, run_, "", [&](int y, int z) {
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

  void fit(int begin, int end, const Run& run) {
    for_rows(begin, end, run, "denoise", [&](int y, int z) {
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
      std::copy_n(fits.is_fitted ? fits.light[w].data() : radiance(s), channels_, smooth_.of(s) + w * channels_);
    findings_.of(s)->variance = all_.look(s)[LatticeSamples::kVariance];
    if (fits.is_fitted) find(s, fits);
  }

  void find(std::size_t s, const wide::WindowFits& fits) {
    WindowFindings& found = *findings_.of(s);
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
  void multiply_rests(int begin, int end) {
    for_each(begin, end, kTouching, [&](std::size_t s, std::span<const std::uint32_t> touching) {
      float weights = 0.0f;
      float sum = 0.0f;
      for (const std::uint32_t other : touching) {
        if (other == s) continue;
        const float w = likeness(s, other);
        weights += w;
        for (std::size_t c = 0; c < channels_; ++c) sum += w * rest(s, c) * rest(other, c);
      }
      findings_.of(s)->product = weights > 0.0f ? sum / (weights * float(channels_)) : 0.0f;
    });
  }

  /// Writes the light of the texels of some layers at their sites.
  void share(int begin, int end, std::vector<float>& values) const {
    for_each(begin, end, kAround, [&](std::size_t s, std::span<const std::uint32_t> around) {
      const bool known = is_known(around);
      const WindowShares shares = known ? WindowShares{} : shares_of(s, around);
      for (std::size_t c = 0; c < channels_; ++c) {
        double e = (known ? 1.0 : shares.back()) * double(radiance(s)[c]);
        for (std::size_t w = 0; w < kWindows.size(); ++w) e += shares[w] * double(smooth(w, s)[c]);
        values[lit_.sites[s] * channels_ + c] =
            known ? float(e / double(unit_)) : std::max(0.0f, float(e / double(unit_)));
      }
    });
  }
  [[nodiscard]] WindowShares shares_of(std::size_t s, std::span<const std::uint32_t> samples) const {
    MeanFindings mean;
    for (const std::uint32_t other : samples) mean.add(likeness(s, other), *findings_.of(other));
    return window_shares(mean.mean());
  }

  std::size_t channels_;
  const Run& run_;
  wide::DenoiseKernels kernels_;
  std::array<int, 3> axes_;  ///< of the texels, those of rows first
  LitTexels lit_;
  TexelLooks looks_;
  int reach_ = 0;  ///< of the stencil, layers
  int layers_a_step_ = 0;
  float unit_ = 1.0f;  ///< a power of two times which the brightest light is some 1 to 2
  LatticeSamples all_;
  SampleWindow<WindowFindings> findings_;
  SampleWindow<float> smooth_;  ///< the windows' light; the channels of each, a sample after the other
  wide::WindowLimits limits_{.counts = kWindows, .apart = kApart, .unseen = 0.0f, .ridge = kRidge, .unit = kUnitLength};
};

}  // namespace

DenoisedLight denoised_light(const Volume& volume, const SampleSet& samples, const Lattice& texels, const Run& run,
                             std::size_t texels_a_step) {
  Denoiser denoiser(volume, texels, samples, texels_a_step, run);
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
