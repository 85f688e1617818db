#include "fit_rows.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sample_looks.h"

namespace isolux {
namespace {

constexpr std::size_t kOpennessTerms = kNearFieldSteps.size();
/// Of the mean weight: no sample counts for nothing.
constexpr double kLeastWeight = 1e-3;
/// Lines of cells.
constexpr std::size_t kLinesABlock = 16;
/// Rows looked at together: few enough to stay in the first cache.
constexpr std::size_t kTogether = 64;

/// From rows' samples to their normals, their openness if asked for, and the roots of the field's steepness.
void look(std::span<const std::uint32_t> samples, const FitTerms& terms, const FitRows::Terms& steps, NearFieldUse use,
          SampleLooks& looks, FitRow* rows, float* weights) {
  looks.look(samples);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const NearField::Ahead& ahead = looks.ahead(i);
    for (std::size_t a = 0; terms.normals && a < 3; ++a)
      rows[i].feature[terms.first_normal() - 1 + a] = float(ahead.downhill[int(a)]);
    weights[i] = float(std::sqrt(ahead.fall));
  }
  for (std::size_t t = 0; use == NearFieldUse::kFitted && t < kOpennessTerms; ++t) {
    looks.find_openness(steps[t]);
    for (std::size_t i = 0; i < samples.size(); ++i) rows[i].openness[t] = looks.openness(i);
  }
}

}  // namespace

FitRows::FitRows(const Volume& volume, const SampleSet& samples, const TexelCells& cells, CellOrder order,
                 const FitTexels& texels, NearFieldUse near_field, const Run& run)
    : starts_(std::move(order.starts)),
      samples_(std::move(order.sites)),
      rows_(std::make_unique_for_overwrite<FitRow[]>(samples_.size())),
      weights_(samples_.size()) {
  const NearField ahead(volume);
  const double outwards = ahead.outwards(samples.sites);
  for (double& step : steps_) step *= outwards;
  measure(ahead, samples, cells, texels, near_field, run);
}

void FitRows::measure(const NearField& near_field, const SampleSet& set, const TexelCells& cells,
                      const FitTexels& texels, NearFieldUse use, const Run& run) {
  const auto ny = std::size_t(cells.size().y);
  const std::size_t lines = ny * std::size_t(cells.size().z);
  std::vector<Terms> blocks(block_count(lines, kLinesABlock), Terms{});
  parallel_blocks(lines, kLinesABlock, run, "", [&](const Block& block) {
    for (std::size_t line = block.begin; line < block.end; ++line) {
      const wide::FitCells along = texels.cells_along(int(line % ny), int(line / ny));
      const std::uint32_t* starts = &starts_[line * along.count];
      for (std::size_t c = 0; c < along.count; ++c) {
        for (std::size_t r = starts[c]; r < starts[c + 1]; ++r) {
          const std::uint32_t sample = samples_[r];
          rows_[r] = {.place = cells.place(set.sites.positions[sample]).in_cell, .feature = {}, .openness = {}};
          if (texels.terms().slopes)
            rows_[r].feature[0] =
                float(double(set.sites.isovalues[sample]) * texels.scale()) - texels.reference(along, c);
        }
      }
    }
    SampleLooks looks(near_field, set.sites);
    const std::size_t end = starts_[block.end * std::size_t(cells.size().x)];
    for (std::size_t r = starts_[block.begin * std::size_t(cells.size().x)]; r < end; r += kTogether) {
      const std::size_t count = std::min(kTogether, end - r);
      look(samples().subspan(r, count), texels.terms(), steps_, use, looks, &rows_[r], &weights_[r]);
      for (std::size_t i = r; i < r + count; ++i) {
        for (std::size_t t = 0; t < kOpennessTerms; ++t) blocks[block.index][t] += double(rows_[i].openness[t]);
      }
    }
  });
  Terms openness{};
  for (const Terms& block : blocks)
    for (std::size_t t = 0; t < kOpennessTerms; ++t) openness[t] += block[t];
  centre(openness, run);
}

void FitRows::centre(const Terms& openness, const Run& run) {
  const auto count = double(size());
  const float most = most_weight(weights_);
  double weight = 0.0;
  for (float& w : weights_) weight += double(w = std::min(w, most)) / count;
  for (std::size_t t = 0; t < kOpennessTerms; ++t) mean_openness_[t] = openness[t] / count;
  parallel_blocks(size(), 65536, run, "", [&](const Block& block) {
    for (std::size_t r = block.begin; r < block.end; ++r) {
      for (std::size_t t = 0; t < kOpennessTerms; ++t) rows_[r].openness[t] -= float(mean_openness_[t]);
      weights_[r] = weight > 0.0 ? float(std::max(double(weights_[r]) / weight, kLeastWeight)) : 1.0f;
    }
  });
}

}  // namespace isolux
