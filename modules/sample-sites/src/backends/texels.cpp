#include <isolux/core/parallel.h>
#include <isolux/sample_sites/site_sampler.h>

namespace isolux {
namespace {

/// One site at the centre of every texel, in the texels' order.
class TexelSampler final : public SiteSampler {
 public:
  using Options = NoOptions;
  explicit TexelSampler(const Options& /*options*/) {}

  [[nodiscard]] Sites sample(const Volume& volume, const SiteRequest& request, const Run& run) const override {
    const IndexToWorld to_volume = index_to_index(request.texels, volume.lattice());
    const auto nx = std::size_t(request.texels.size.x);
    const auto ny = std::size_t(request.texels.size.y);
    std::vector<Vec3f> positions(request.texels.count());
    parallel_blocks(positions.size(), 1 << 14, run, {}, [&](const Block& block) {
      for (std::size_t t = block.begin; t < block.end; ++t) {
        const std::size_t slab = t / (nx * ny);
        const std::size_t row = t / nx % ny;
        positions[t] = Vec3f(to_volume.world(Vec3(double(t % nx), double(row), double(slab))));
      }
    });
    return make_sites(volume, std::move(positions), request, run);
  }
};

}  // namespace

namespace backends {
void texels(Registry<SiteSampler>& registry) {
  registry.add<TexelSampler>("texels", "one site at the centre of every texel: what the direct resampler wants");
}
}  // namespace backends

}  // namespace isolux
