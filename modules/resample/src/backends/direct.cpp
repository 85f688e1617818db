#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/resample/resampler.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "denoise.h"
#include "lit_texels.h"
#include "near_field.h"
#include "samples.h"
#include "sharpen.h"
#include "texel_near_field.h"

namespace isolux::backends {
namespace {

/// Samples whose texels are found together.
constexpr std::size_t kSamplesAPass = 65536;

class Direct final : public Resampler {
 public:
  struct Options {
    bool denoise = false;
    bool near_field = true;
    bool spread = true;
    bool sharpen = true;

    void describe(OptionVisitor& option) {
      option("denoise", denoise, {.help = "take the rays' noise out where the samples around say that it is noise"});
      option("near_field", near_field,
             {.help = "say beside the texels how open the volume itself is in front of a point, for reading between"});
      option(
          "spread", spread,
          {.help = "with denoise, and no reflections: rays of a site more or fewer by the noise about it, as many on "
                   "average"});
      option("sharpen", sharpen,
             {.help = "with denoise: give texels a little more contrast than light has there, which "
                      "reading between them takes away"});
    }
  };
  explicit Direct(const Options& options) : options_(options) {}

  ResampledGrid resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                         const Run& run) const override {
    require_samples(samples);
    require_texels(texels);
    if (!options_.denoise) return told_by_bytes(placed(volume, samples, samples.radiance, texels, run));
    const DenoisedLight light = denoised_light(volume, samples, texels, run);
    IlluminationGrid result = placed(volume, samples, light.rest, texels, run);
    if (options_.sharpen) {
      const std::vector<float>& before = light.lamps.empty() ? samples.radiance : light.noisy_rest;
      sharpen(result, placed(volume, samples, before, texels, run), run);
    }
    if (!light.lamps.empty()) add(placed(volume, samples, light.lamps, texels, run), result);
    return told_by_bytes(std::move(result));
  }

  [[nodiscard]] bool takes_parts() const override { return !options_.denoise; }

  void add_part(const Volume& volume, const SampleSet& samples, IlluminationGrid& texels,
                const Run& run) const override {
    require_placed(samples);
    require_complete(texels);
    if (samples.channels != texels.channels) {
      throw InvalidInput(fmt::format("samples of {} channels for a light of {}: they must be as many", samples.channels,
                                     texels.channels));
    }
    place(volume, samples.sites, samples.radiance, texels, run);
  }

  [[nodiscard]] LampLight lamps() const override {
    return options_.denoise ? LampLight::kToldApart : LampLight::kWithin;
  }

  [[nodiscard]] RaySpread spread() const override {
    return options_.denoise && options_.spread ? RaySpread::kByNoise : RaySpread::kEven;
  }

  [[nodiscard]] bool has_near_field() const override { return options_.near_field; }

  void add_detail(const Volume& volume, const SampleSet& samples, ResampledGrid& texels,
                  const Run& run) const override {
    if (options_.near_field) estimate_near_field(volume, NearField(volume).outwards(samples.sites), texels, run);
    if (options_.denoise) keep_to_brightest(samples, texels.grid);
  }

 private:
  /// One value a sample and channel at the samples' texels.
  static IlluminationGrid placed(const Volume& volume, const SampleSet& samples, const std::vector<float>& light,
                                 const Lattice& texels, const Run& run) {
    IlluminationGrid grid = unlit_grid(texels, samples.channels);
    place(volume, samples.sites, light, grid, run);
    return grid;
  }

  /// What is fitted or sharpened may overshoot, and nothing is read that is brighter than the brightest sample. Where
  /// reading has a bound, texels may: they are sharpened so that what is read between them is right.
  static void keep_to_brightest(const SampleSet& samples, IlluminationGrid& light) {
    const auto channels = std::size_t(light.channels);
    std::array<float, 3> brightest{};
    for (std::size_t v = 0; v < samples.radiance.size(); ++v)
      brightest[v % channels] = std::max(brightest[v % channels], samples.radiance[v]);
    if (!light.detail.empty()) {
      light.detail.ceiling = std::min(light.detail.ceiling, *std::max_element(brightest.begin(), brightest.end()));
      return;
    }
    for (std::size_t v = 0; v < light.values.size(); ++v)  // NaN, of texels without light, stays
      light.values[v] = std::min(light.values[v], brightest[v % channels]);
  }

  static void add(const IlluminationGrid& part, IlluminationGrid& sum) {
    for (std::size_t v = 0; v < sum.values.size(); ++v) sum.values[v] += part.values[v];
  }

  static void place(const Volume& volume, const Sites& sites, const std::vector<float>& light, IlluminationGrid& result,
                    const Run& run) {
    const Lattice& texels = result.lattice;
    const IndexToWorld to_texels = index_to_index(volume.lattice(), texels);
    const auto channels = std::size_t(result.channels);
    std::vector<std::size_t> repeated;
    std::vector<std::optional<std::size_t>> found(kSamplesAPass);
    for (std::size_t first = 0; first < sites.size(); first += kSamplesAPass) {
      const std::size_t count = std::min(kSamplesAPass, sites.size() - first);
      parallel_blocks(count, kSamplesAPass / 16, run, "", [&](const Block& block) {
        for (std::size_t i = block.begin; i < block.end; ++i)
          found[i] = point_at(texels, to_texels.world(Vec3(sites.positions[first + i])));
      });
      for (std::size_t i = 0; i < count; ++i) {
        float* const values = &result.values[texel_of(sites, first + i, found[i]) * channels];
        if (std::isnan(*values)) {
          std::copy_n(&light[(first + i) * channels], channels, values);
        } else {
          repeated.push_back(first + i);
        }
      }
    }
    add_repeated(sites, light, to_texels, repeated, result);
  }

  /// Texels with several samples get their mean.
  static void add_repeated(const Sites& sites, const std::vector<float>& light, const IndexToWorld& to_texels,
                           const std::vector<std::size_t>& repeated, IlluminationGrid& grid) {
    if (repeated.empty()) return;
    const auto channels = std::size_t(grid.channels);
    std::vector<std::uint32_t> count(grid.lattice.count(), 1);
    for (const std::size_t s : repeated) {
      const std::size_t texel = *point_at(grid.lattice, to_texels.world(Vec3(sites.positions[s])));
      const double share = 1.0 / double(++count[texel]);
      for (std::size_t c = 0; c < channels; ++c) {
        float& value = grid.values[texel * channels + c];
        value = float(double(value) + share * (double(light[s * channels + c]) - double(value)));
      }
    }
  }

  Options options_;
};

}  // namespace

void direct(Registry<Resampler>& registry) {
  registry.add<Direct>("direct", "takes samples that sit at the texel centres as they are; texels without stay unlit");
}

}  // namespace isolux::backends
