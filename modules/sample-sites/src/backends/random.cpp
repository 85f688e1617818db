#include <isolux/core/random.h>
#include <isolux/sample_sites/site_sampler.h>

#include "collect_sites.h"

namespace isolux {
namespace {

/// Independent uniform sites: the thesis's first choice and the yardstick of the others.
class RandomSampler final : public SiteSampler {
 public:
  using Options = NoOptions;
  explicit RandomSampler(const Options& /*options*/) {}

  [[nodiscard]] Sites sample(const Volume& volume, const SiteRequest& request, const Run& run) const override {
    const ActiveCells cells(volume, request.isovalues, run);
    const UnitSequence uniform = [seed = run.seed](std::uint64_t i) {
      RandomStream random(seed, i);
      const double x = random.uniform_double();
      const double y = random.uniform_double();
      return Vec3(x, y, random.uniform_double());
    };
    return collect_sites(volume, request, cells, wanted_sites(request, cells), uniform, run);
  }
};

}  // namespace

namespace backends {
void random(Registry<SiteSampler>& registry) {
  registry.add<RandomSampler>("random", "independent sites, uniform in the volume that can be lit");
}
}  // namespace backends

}  // namespace isolux
