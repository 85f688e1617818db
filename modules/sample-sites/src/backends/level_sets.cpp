#include <isolux/core/field.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/sample_sites/site_sampler.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "collect_sites.h"

namespace isolux {
namespace {

constexpr int kTries = 32;  // a line through a cell that misses the level set drawn; corners are missed often
constexpr std::size_t kPointsABlock = 4096;
/// Rounding a position to float moves the isovalue by less than this part of the range of values, up to some 10,000
/// voxels an axis.
constexpr float kRounding = 1e-3f;

ValueRange cell_range(const Volume& volume, const Index3& cell) {
  ValueRange range{.low = std::numeric_limits<float>::infinity(), .high = -std::numeric_limits<float>::infinity()};
  for (int q = 0; q < 8; ++q) {
    const float v = volume.values(cell.x + (q & 1), cell.y + (q >> 1 & 1), cell.z + (q >> 2));
    range = {.low = std::min(range.low, v), .high = std::max(range.high, v)};
  }
  return range;
}

/// A point of a random level set of `range` in a cell: from a random point along the axis of the steepest change, along
/// which f is linear. Nothing if the line meets it outside the cell.
std::optional<Vec3f> level_set_point(const TrilinearField& field, const Index3& cell, const ValueRange& range,
                                     RandomStream& random) {
  Vec3 point(cell);
  for (int a = 0; a < 3; ++a) point[a] += random.uniform_double();
  const double isovalue = double(range.low) + random.uniform_double() * (double(range.high) - double(range.low));
  const Vec3 gradient = field.cell_gradient(point);
  int axis = 0;
  for (int a = 1; a < 3; ++a) axis = std::fabs(gradient[a]) > std::fabs(gradient[axis]) ? a : axis;
  if (gradient[axis] == 0.0) return std::nullopt;
  point[axis] += (isovalue - field.value(point)) / gradient[axis];
  if (!(point[axis] > double(cell[axis]) && point[axis] < double(cell[axis]) + 1.0)) return std::nullopt;
  return Vec3f(point);
}

/// The same number of sites in every cell that the asked level sets cross, on them: steep cells hold little of a
/// range's volume and as much of its surfaces as others.
class LevelSetSampler final : public SiteSampler {
 public:
  using Options = NoOptions;
  explicit LevelSetSampler(const Options& /*options*/) {}

  [[nodiscard]] Sites sample(const Volume& volume, const SiteRequest& request, const Run& run) const override {
    throw_if_stopped(run);
    const ActiveCells cells(volume, request.isovalues, run);
    const std::size_t count = wanted_sites(request, cells);
    if (cells.empty() || count == 0) return {};
    const ValueRange all = value_range(volume);
    const ValueRange asked = request.isovalues.value_or(all);
    const TrilinearField field(volume);
    std::vector<Vec3f> positions(count);
    parallel_blocks(count, kPointsABlock, run, "sites", [&](const Block& block) {
      for (std::size_t i = block.begin; i < block.end; ++i) {
        const Index3 cell = cells.cell(std::size_t(double(i) / double(count) * double(cells.size())));
        const ValueRange own = cell_range(volume, cell);
        const ValueRange range{.low = std::max(own.low, asked.low), .high = std::min(own.high, asked.high)};
        RandomStream random(run.seed, i);
        std::optional<Vec3f> found;
        for (int t = 0; t < kTries && !found; ++t) found = level_set_point(field, cell, range, random);
        positions[i] = found.value_or(Vec3f(std::numeric_limits<float>::quiet_NaN()));
      }
    });
    SiteRequest checked = request;
    // Floats seldom lie on one level set exactly. The site is on that of its own position, beside the one asked.
    const float slack = kRounding * (all.high - all.low);
    if (asked.high - asked.low < slack) {
      checked.isovalues = ValueRange{.low = asked.low - slack, .high = asked.high + slack};
    }
    return make_sites(volume, std::move(positions), checked, run);
  }
};

}  // namespace

namespace backends {
void level_sets(Registry<SiteSampler>& registry) {
  registry.add<LevelSetSampler>("level_sets",
                                "as many sites in each cell that the asked level sets cross, on them: for a known "
                                "isovalue or range");
}
}  // namespace backends

}  // namespace isolux
