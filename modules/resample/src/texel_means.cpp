#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/field.h>
#include <isolux/core/parallel.h>
#include <isolux/core/quantile.h>
#include <isolux/resample/texel_means.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cell_places.h"
#include "texel_breadths.h"

namespace isolux {
namespace {

using Corners = std::array<std::size_t, 8>;

/// Isovalues that lie closer together than this part of the span of nine sites in ten say nothing of a slope: rounding
/// would be seen through it. Not of the volume's range, which a single voxel can make any number of times as large.
constexpr float kLeastSpread = 1e-4f;
/// The same of how much f changes where the texel is read: a line is not drawn so far beyond its sites.
constexpr float kLeastOfBreadth = 0.01f;
/// Of the volume's range: squares of less are beyond floats.
constexpr float kLeastOfRange = 1e-15f;
constexpr float kSlopePrior = 0.25f;  // samples that say that light does not change with the isovalue

}  // namespace

struct TexelMeans::Impl {
  struct Row {
    std::array<float, 3> in_cell;
    float isovalue;
    std::uint32_t site;
  };
  /// Of the samples around a texel.
  struct Spread {
    float weight = 0.0f;
    float isovalue = 0.0f;  ///< mean
    float lever = 0.0f;     ///< sum of weight times isovalue less mean: what rounding of the mean leaves
    float per_slope = 0.0f;
    float own = 0.0f;  ///< isovalue of the texel, less the mean
  };

  Impl(const Volume& volume, const Sites& sites, const Lattice& lattice, const Run& run)
      : texels(lattice), cells(TexelCells(volume.lattice(), lattice).size()), unit(to_unit(value_range(volume))) {
    const TexelCells places(volume.lattice(), texels);
    CellOrder order = sort_by_cells(places, sites, run);
    starts = std::move(order.starts);
    rows.resize(sites.size());
    parallel_blocks(rows.size(), 65536, run, "", [&](const Block& block) {
      for (std::size_t r = block.begin; r < block.end; ++r) {
        const std::uint32_t site = order.sites[r];
        rows[r] = {.in_cell = places.place(sites.positions[site]).in_cell,
                   .isovalue = unit * sites.isovalues[site],
                   .site = site};
      }
    });
    measure(volume, sites, run);
  }

  /// A power of two times which the volume's values span some 1 to 2: squares of isovalues are taken.
  [[nodiscard]] static float to_unit(const ValueRange& range) {
    return range.high > range.low ? std::ldexp(1.0f, -std::ilogb(0.5f * range.high - 0.5f * range.low)) : 1.0f;
  }

  /// Calls visit(corners, rows) for every cell with rows: cells of one layer after another, even layers before odd
  /// ones, which write apart.
  template <class Visit>
  void for_each_cell(const Run& run, const Visit& visit) const {
    const std::size_t steps[3] = {texels.size.x > 1 ? 1u : 0u, texels.size.y > 1 ? std::size_t(texels.size.x) : 0u,
                                  texels.size.z > 1 ? std::size_t(texels.size.x) * std::size_t(texels.size.y) : 0u};
    const auto layer = [&](int k) {
      std::size_t cell = std::size_t(k) * std::size_t(cells.y) * std::size_t(cells.x);
      for (int j = 0; j < cells.y; ++j) {
        for (int i = 0; i < cells.x; ++i, ++cell) {
          const std::span here(rows.data() + starts[cell], starts[cell + 1] - starts[cell]);
          if (here.empty()) continue;
          Corners corners{};
          for (unsigned q = 0; q < 8; ++q)
            corners[q] = texels.offset(i, j, k) + (q & 1u) * steps[0] + (q >> 1 & 1u) * steps[1] + (q >> 2) * steps[2];
          visit(corners, here);
        }
      }
    };
    for (int parity = 0; parity < 2; ++parity) {
      const int layers = (cells.z - parity + 1) / 2;
      parallel_blocks(std::size_t(layers), 1, run, "",
                      [&](const Block& block) { layer(parity + 2 * int(block.begin)); });
    }
  }

  void measure(const Volume& volume, const Sites& sites, const Run& run);
  template <int channels>
  void add_up(std::span<const float> radiance, std::vector<float>& sums, const Run& run) const;
  void lines(std::span<const float> sums, ResampledGrid& result, const Run& run) const;

  Lattice texels;
  Index3 cells;
  float unit;                         ///< what isovalues here are multiplied by
  std::vector<std::uint32_t> starts;  ///< of each cell's rows, and the end
  std::vector<Row> rows;
  std::vector<Spread> spreads;  ///< of every texel
};

void TexelMeans::Impl::measure(const Volume& volume, const Sites& sites, const Run& run) {
  spreads.resize(texels.count());
  std::vector<double> moments(texels.count(), 0.0);
  for_each_cell(run, [&](const Corners& corners, std::span<const Row> here) {
    PerCorner<float> total{};
    std::array<double, 8> moment{};
    for (const Row& row : here) {
      const PerCorner<float> w = corner_weights(row.in_cell);
      for (unsigned q = 0; q < 8; ++q) total[q] += w[q];
      for (unsigned q = 0; q < 8; ++q) moment[q] += double(w[q]) * double(row.isovalue);
    }
    for (unsigned q = 0; q < 8; ++q) {
      spreads[corners[q]].weight += total[q];
      moments[corners[q]] += moment[q];
    }
  });
  for (std::size_t t = 0; t < spreads.size(); ++t)
    if (spreads[t].weight > 0.0f) spreads[t].isovalue = float(moments[t] / double(spreads[t].weight));
  for_each_cell(run, [&](const Corners& corners, std::span<const Row> here) {
    PerCorner<float> lever{};
    PerCorner<float> squares{};
    for (const Row& row : here) {
      const PerCorner<float> w = corner_weights(row.in_cell);
      for (unsigned q = 0; q < 8; ++q) {
        const float d = row.isovalue - spreads[corners[q]].isovalue;
        lever[q] += w[q] * d;
        squares[q] += w[q] * d * d;
      }
    }
    for (unsigned q = 0; q < 8; ++q) {
      spreads[corners[q]].lever += lever[q];
      spreads[corners[q]].per_slope += squares[q];
    }
  });
  const TrilinearField field(volume);
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  const float usual = unit * quantile(sites.isovalues, 0.95) - unit * quantile(sites.isovalues, 0.05);
  const TexelBreadths breadths(volume, texels);
  const auto nx = std::size_t(texels.size.x);
  const auto ny = std::size_t(texels.size.y);
  parallel_blocks(spreads.size(), 4096, run, "", [&](const Block& block) {
    for (std::size_t t = block.begin; t < block.end; ++t) {
      Spread& spread = spreads[t];
      if (!(spread.weight > 0.0f)) continue;
      const std::size_t j = t / nx % ny;
      const std::size_t k = t / (nx * ny);
      const Vec3 centre = to_volume.world({double(t % nx), double(j), double(k)});
      spread.own = unit * float(field.value(centre)) - spread.isovalue;
      // The prior's samples lie as far apart as the others, or as far off as the texel: few samples that lie close
      // together do not say what light is there.
      const float least =
          std::max({kLeastSpread * usual, kLeastOfBreadth * unit * float(breadths.at(centre)), kLeastOfRange});
      const float prior = kSlopePrior * (spread.per_slope / spread.weight + spread.own * spread.own);
      spread.per_slope = 1.0f / (spread.per_slope + prior + least * least);
    }
  });
}

template <int channels>
void TexelMeans::Impl::add_up(std::span<const float> radiance, std::vector<float>& sums, const Run& run) const {
  for_each_cell(run, [&](const Corners& corners, std::span<const Row> here) {
    std::array<PerCorner<float>, channels> light{};
    std::array<PerCorner<float>, channels> moment{};
    PerCorner<float> isovalue{};
    for (unsigned q = 0; q < 8; ++q) isovalue[q] = spreads[corners[q]].isovalue;
    for (const Row& row : here) {
      const PerCorner<float> w = corner_weights(row.in_cell);
      for (std::size_t c = 0; c < channels; ++c) {
        const float e = radiance[row.site * std::size_t(channels) + c];
        for (unsigned q = 0; q < 8; ++q) {
          light[c][q] += w[q] * e;
          moment[c][q] += w[q] * e * (row.isovalue - isovalue[q]);
        }
      }
    }
    for (unsigned q = 0; q < 8; ++q) {
      float* sum = &sums[corners[q] * 2 * channels];
      for (std::size_t c = 0; c < channels; ++c) {
        sum[2 * c] += light[c][q];
        sum[2 * c + 1] += moment[c][q];
      }
    }
  });
}

void TexelMeans::Impl::lines(std::span<const float> sums, ResampledGrid& result, const Run& run) const {
  const auto channels = std::size_t(result.grid.channels);
  parallel_blocks(spreads.size(), 65536, run, "", [&](const Block& block) {
    for (std::size_t t = block.begin; t < block.end; ++t) {
      const Spread& spread = spreads[t];
      if (!(spread.weight > 0.0f)) continue;
      result.lit[t] = 1;
      for (std::size_t v = t * channels; v < (t + 1) * channels; ++v) {
        const float mean = sums[2 * v] / spread.weight;
        const float slope = (sums[2 * v + 1] - spread.lever * mean) * spread.per_slope;
        result.grid.detail.slopes[v] = slope * unit;
        result.grid.values[v] = mean + slope * spread.own;
      }
    }
  });
}

TexelMeans::TexelMeans(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run)
    : impl_(std::make_unique<const Impl>(volume, sites, texels, run)) {}

TexelMeans::~TexelMeans() = default;
TexelMeans::TexelMeans(TexelMeans&&) noexcept = default;
TexelMeans& TexelMeans::operator=(TexelMeans&&) noexcept = default;

ResampledGrid TexelMeans::of(std::span<const float> radiance, int channels, const Run& run) const {
  if (channels != 1 && channels != 3)
    throw InvalidInput(fmt::format("samples of {} channels: allowed are 1 and 3", channels));
  if (radiance.size() != impl_->rows.size() * std::size_t(channels))
    throw InvalidInput(fmt::format("{} radiances for {} sites of {} channels: one of each is needed", radiance.size(),
                                   impl_->rows.size(), channels));
  ResampledGrid result{.grid = IlluminationGrid(impl_->texels, channels),
                       .lit = std::vector<std::uint8_t>(impl_->texels.count(), 0)};
  result.grid.detail.slopes.assign(result.grid.values.size(), 0.0f);
  std::vector<float> sums(2 * result.grid.values.size(), 0.0f);
  if (channels == 1) {
    impl_->add_up<1>(radiance, sums, run);
  } else {
    impl_->add_up<3>(radiance, sums, run);
  }
  impl_->lines(sums, result, run);
  return result;
}

}  // namespace isolux
