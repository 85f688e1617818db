#include "denoise.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "local_fit.h"
#include "sample_bins.h"
#include "shepard.h"

namespace isolux {
namespace {

constexpr int kNeighbours = 33;  // the 27 texels around and some more; 81 blur more light than noise
constexpr double kIsovalueLength =
    2.0;  // of the whole range in grid steps: a coordinate of the fit, hardly of the search
constexpr double kRidge = 0.02;
/// The spread of thirty samples with nothing but noise is rarely this much above their variance.
constexpr double kDoubt = 1.25;

class Denoiser {
 public:
  Denoiser(const Volume& volume, const SampleSet& samples, const Run& run)
      : samples_(samples),
        run_(run),
        space_(volume, samples, ShepardOptions{.k = kNeighbours, .isovalue_length = kIsovalueLength}),
        bins_(space_.samples(), space_.far_corner(), 1.0) {}

  [[nodiscard]] std::vector<float> smooth() const {
    std::vector<float> values(samples_.radiance.size());
    const auto channels = std::size_t(samples_.channels);
    for_each([&](std::size_t s, const std::vector<Neighbour>& found) {
      const Point& here = space_.samples()[s];
      const double reach = 1.0001 * double(found.back().reach());
      LocalFit fit;
      for (const Neighbour& n : found) {
        const Point& p = space_.samples()[n.sample()];
        const double ratio = reach > 0.0 ? double(n.reach()) / reach : 0.0;
        fit.add((1.0 - 0.75 * ratio) * likeness(s, n.sample()) + 1e-6,
                {double(p.x[0]) - double(here.x[0]), double(p.x[1]) - double(here.x[1]),
                 double(p.x[2]) - double(here.x[2]), double(p.x[3]) - double(here.x[3])},
                &samples_.radiance[n.sample() * channels], channels);
      }
      fit.at_origin(kRidge, &values[s * channels], channels);
    });
    return values;
  }

  /// smooth + k (radiance - smooth).
  [[nodiscard]] std::vector<float> blend(const std::vector<float>& smooth) const {
    std::vector<float> values(samples_.radiance.size());
    const auto channels = std::size_t(samples_.channels);
    for_each([&](std::size_t s, const std::vector<Neighbour>& found) {
      double weights = 1e-6;
      double spread = 0.0;
      double noise = 0.0;
      for (const Neighbour& n : found) {
        const double w = likeness(s, n.sample());
        weights += w;
        noise += w * double(samples_.variance[n.sample()]);
        for (std::size_t v = n.sample() * channels; v < (n.sample() + 1) * channels; ++v) {
          const double rest = double(samples_.radiance[v]) - double(smooth[v]);
          spread += w * rest * rest / double(channels);
        }
      }
      const double kept = spread > kDoubt * noise ? 1.0 - kDoubt * noise / spread : 0.0;
      for (std::size_t v = s * channels; v < (s + 1) * channels; ++v) {
        values[v] =
            std::max(0.0f, float(double(smooth[v]) + kept * (double(samples_.radiance[v]) - double(smooth[v]))));
      }
    });
    return values;
  }

 private:
  template <class Visit>
  void for_each(const Visit& visit) const {
    parallel_blocks(samples_.size(), 512, run_, "denoise", [&](const Block& block) {
      std::vector<Neighbour> found;
      for (std::size_t s = block.begin; s < block.end; ++s) {
        bins_.search<EuclideanMetric>(space_.samples()[s], space_.limits(), found);
        visit(s, found);
      }
    });
  }

  /// Of two samples' light, by their normals.
  [[nodiscard]] double likeness(std::size_t a, std::size_t b) const {
    const double cosine = double(glm::dot(samples_.sites.normals[a], samples_.sites.normals[b]));
    return cosine > 0.0 ? cosine * cosine : 0.0;
  }

  const SampleSet& samples_;
  const Run& run_;
  ShepardSpace space_;
  SampleBins bins_;
};

}  // namespace

SampleSet denoised(const Volume& volume, const SampleSet& samples, const Run& run) {
  const Denoiser denoiser(volume, samples, run);
  SampleSet result = samples;
  result.radiance = denoiser.blend(denoiser.smooth());
  return result;
}

}  // namespace isolux
