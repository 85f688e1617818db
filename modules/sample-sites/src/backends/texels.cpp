#include <isolux/core/parallel.h>
#include <isolux/sample_sites/site_sampler.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "texel_rows.h"

namespace isolux {
namespace {

/// One site at the centre of every texel, in the texels' order.
class TexelSampler final : public SiteSampler {
 public:
  using Options = NoOptions;
  explicit TexelSampler(const Options& /*options*/) {}

  [[nodiscard]] Sites sample(const Volume& volume, const SiteRequest& request, const Run& run) const override {
    const Index3& size = request.texels.size;
    const TexelRows rows(volume, request.texels);
    // Of a range most texels may lie outside: they cost no more than a look at their isovalue.
    std::vector<std::vector<int>> columns(request.isovalues ? rows.count() : 0);
    if (request.isovalues) {
      parallel_blocks(rows.count(), 16, run, {}, [&](const Block& block) {
        for (std::size_t r = block.begin; r < block.end; ++r) columns[r] = rows.columns_within(r, *request.isovalues);
      });
    }
    std::vector<std::size_t> begins{0};
    for (std::size_t r = 0; r < rows.count(); ++r)
      begins.push_back(begins.back() + (request.isovalues ? columns[r].size() : std::size_t(size.x)));
    std::vector<Vec3f> positions(begins.back());
    parallel_blocks(rows.count(), 64, run, {}, [&](const Block& block) {
      for (std::size_t r = block.begin; r < block.end; ++r) {
        for (std::size_t n = 0; n < begins[r + 1] - begins[r]; ++n)
          positions[begins[r] + n] = rows.position(r, request.isovalues ? columns[r][n] : int(n));
      }
    });
    columns = {};
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
