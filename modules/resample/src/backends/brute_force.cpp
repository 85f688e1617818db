#include "shepard_choice.h"
#include "shepard_resample.h"

namespace isolux::backends {
namespace {

class BruteForce final : public Resampler {
 public:
  using Options = ShepardOptions;
  explicit BruteForce(const Options& options) : options_(options) {}

  ResampledGrid resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                         const Run& run) const override {
    const ShepardOptions options = chosen_by_samples(options_, volume, samples, run);
    const ShepardSpace space(volume, samples, options);
    return with_metric(options.distance, [&](auto metric) {
      using Metric = decltype(metric);
      const auto search = [&](const Point& query, std::vector<Neighbour>& found) {
        NearestNeighbours nearest(space.limits(), found);
        std::uint32_t sample = 0;
        for (const Point& p : space.samples()) nearest.offer(reach<Metric>(query, p), sample++);
        nearest.finish();
      };
      return shepard_resample(volume, samples, texels, options, space, search, run);
    });
  }

 private:
  Options options_;
};

}  // namespace

void brute_force(Registry<Resampler>& registry) {
  registry.add<BruteForce>(
      "brute_force",
      "Shepard's interpolation with every sample tried for every texel: the thesis, and the oracle "
      "of the other two");
}

}  // namespace isolux::backends
