#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "local_fit.h"
#include "sample_bins.h"
#include "samples.h"
#include "shepard_resample.h"

namespace isolux::backends {
namespace {

class MovingLeastSquares final : public Resampler {
 public:
  struct Options {
    int k = 0;
    double isovalue_length = 0.0;
    double normal_power = 0.0;
    double ridge = 0.02;

    void describe(OptionVisitor& option) {
      option("k", k,
             {.min = 0, .max = 1024, .help = "nearest samples taken; 0: 16, and up to 64 the noisier they are"});
      option("isovalue_length", isovalue_length,
             {.min = 0.0,
              .max = 1e6,
              .unit = "mean grid spacings",
              .help = "length that the whole range of values counts as in the distance; 0: it is in space alone"});
      option(
          "normal_power", normal_power,
          {.min = 0.0, .max = 64.0, .help = "samples count by this power of their normal's cosine with the texel's"});
      option("ridge", ridge, {.min = 1e-9, .max = 1e3, .help = "pull of the fitted slopes to zero"});
    }
  };
  explicit MovingLeastSquares(const Options& options) : options_(options) {}

  ResampledGrid resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                         const Run& run) const override {
    require_samples(samples);
    ShepardOptions neighbours;
    neighbours.k = options_.k > 0 ? options_.k : count_for(samples);
    neighbours.isovalue_length = options_.isovalue_length;
    const ShepardSpace space(volume, samples, neighbours);
    const SampleBins bins(space.samples(), space.far_corner(), 1.0);
    const TrilinearField field(volume);
    const auto search = [&](const Point& query, std::vector<Neighbour>& found) {
      bins.search<EuclideanMetric>(query, space.limits(), found);
    };
    const auto light = [&](const Vec3f& index, const Point& query, std::span<const Neighbour> found, float* texel) {
      const Vec3 normal = options_.normal_power > 0.0
                              ? field.world_gradient(Vec3(index), GradientKind::kCentralDifferences)
                              : Vec3(0.0);
      fit_texel(samples, space, query, normal, found, texel);
    };
    return resample_texels(volume, samples, texels, space, search, light, run);
  }

 private:
  /// Enough samples that what noise leaves in their mean is a tenth of the light's own size.
  [[nodiscard]] static int count_for(const SampleSet& samples) {
    return int(std::clamp(16.0 * (1.0 + 100.0 * relative_noise(samples)), 16.0, 64.0));
  }

  void fit_texel(const SampleSet& samples, const ShepardSpace& space, const Point& query, const Vec3& gradient,
                 std::span<const Neighbour> found, float* texel) const {
    const auto channels = std::size_t(samples.channels);
    const double reach = double(found.back().reach()) * 1.0001;
    const double steepness = glm::length(gradient);
    LocalFit<4> fit;
    float low[3] = {INFINITY, INFINITY, INFINITY};
    float high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (const Neighbour& n : found) {
      const double ratio = reach > 0.0 ? double(n.reach()) / reach : 0.0;
      double weight = (1.0 - ratio) * (1.0 - ratio) + 1e-6;
      if (steepness > 0.0) {
        const double cosine = std::fabs(glm::dot(Vec3(samples.sites.normals[n.sample()]), gradient)) / steepness;
        weight *= std::pow(cosine, options_.normal_power) + 1e-3;
      }
      const Point& p = space.samples()[n.sample()];
      const float* light = &samples.radiance[n.sample() * channels];
      fit.add(weight,
              {double(p.x[0]) - double(query.x[0]), double(p.x[1]) - double(query.x[1]),
               double(p.x[2]) - double(query.x[2]), double(p.x[3]) - double(query.x[3])},
              light, channels);
      for (std::size_t c = 0; c < channels; ++c) {
        low[c] = std::min(low[c], light[c]);
        high[c] = std::max(high[c], light[c]);
      }
    }
    fit.at_origin(options_.ridge, texel, channels);
    // A linear function may leave the light that there is, across a shadow's edge above all.
    for (std::size_t c = 0; c < channels; ++c) texel[c] = std::clamp(texel[c], low[c], high[c]);
  }

  Options options_;
};

}  // namespace

void moving_least_squares(Registry<Resampler>& registry) {
  registry.add<MovingLeastSquares>(
      "moving_least_squares",
      "a linear function fitted to the nearest samples of each texel, more of them the noisier");
}

}  // namespace isolux::backends
