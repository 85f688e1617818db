#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/sample_sites/site_sampler.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "site_maker.h"
#include "site_pieces.h"
#include "texel_rows.h"

namespace isolux {
namespace {

/// The rows of texels are taken in so many slabs: of a slab every texel may be looked at, of the others only sites
/// stay.
constexpr std::size_t kSlabs = 8;
constexpr std::size_t kRowsABlock = 64;
constexpr std::size_t kPositionsAtOnce = 1024;

/// One site at the centre of every texel, in the texels' order.
class TexelSampler final : public SiteSampler {
 public:
  using Options = NoOptions;
  explicit TexelSampler(const Options& /*options*/) {}

  [[nodiscard]] Sites sample(const Volume& volume, const SiteRequest& request, const Run& run) const override {
    if (request.only != nullptr && request.only->size() != request.texels.size) {
      const Index3& mask = request.only->size();
      const Index3& size = request.texels.size;
      throw InvalidInput(fmt::format("a mask of {}x{}x{} texels for a grid of {}x{}x{}: they must be the same", mask.x,
                                     mask.y, mask.z, size.x, size.y, size.z));
    }
    const TexelRows rows(volume, request);
    const SiteMaker maker(volume, request);
    const std::size_t slab = std::max(kRowsABlock, rows.count() / kSlabs);
    SitePieces pieces;
    for (std::size_t first = 0; first < rows.count(); first += slab) {
      const std::size_t last = std::min(rows.count(), first + slab);
      std::vector<Sites> found(block_count(last - first, kRowsABlock));
      parallel_blocks(found.size(), 1, run, {}, [&](const Block& block) {
        const std::size_t begin = first + block.index * kRowsABlock;
        append_rows(rows, begin, std::min(last, begin + kRowsABlock), request, maker, found[block.index]);
      });
      for (const Sites& sites : found) pieces.append(sites);
    }
    return std::move(pieces).joined();
  }

 private:
  static void append_rows(const TexelRows& rows, std::size_t begin, std::size_t end, const SiteRequest& request,
                          const SiteMaker& maker, Sites& sites) {
    TexelRows::Scratch scratch;
    std::vector<Vec3f> positions;
    for (std::size_t row = begin; row < end; ++row) {
      const auto add = [&](int x) {
        if (request.only == nullptr || (*request.only)[row * std::size_t(request.texels.size.x) + std::size_t(x)])
          positions.push_back(rows.position(row, x));
      };
      if (request.isovalues) {
        // Of a range most texels may lie outside: they cost no more than a look at their isovalue.
        for (const int x : rows.columns_within(row, *request.isovalues, scratch)) add(x);
      } else {
        for (int x = 0; x < request.texels.size.x; ++x) add(x);
      }
      if (positions.size() < kPositionsAtOnce && row + 1 < end) continue;
      maker.append(positions, sites);
      positions.clear();
    }
  }
};

}  // namespace

namespace backends {
void texels(Registry<SiteSampler>& registry) {
  registry.add<TexelSampler>("texels", "one site at the centre of every texel: what the direct resampler wants");
}
}  // namespace backends

}  // namespace isolux
