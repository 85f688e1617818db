#include "fit_system.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "cell_places.h"

namespace isolux {
namespace {

constexpr std::size_t kTerms = kNearFieldSteps.size();
static_assert(kTerms == 4, "terms are added beside four corners");

/// Of a row's weight where its reading is clamped. None would be Newton's method, whose step knows no bound where all
/// rows around a texel are.
constexpr float kClampedPart = 0.1f;

}  // namespace

FitSystem::FitSystem(const Volume& volume, const SampleSet& samples, const Lattice& texels, const FitTerms& terms,
                     NearFieldUse near_field, const Run& run)
    : kernels_(wide::fit_kernels(terms.count())), run_(run) {
  const TexelCells cells(volume.lattice(), texels);
  CellOrder order = sort_by_cells(cells, samples.sites, run);
  texels_.emplace(volume, texels, order.starts, terms, run);
  rows_.emplace(volume, samples, cells, std::move(order), *texels_, near_field, run);
  std::vector<float> coverage;
  texel_weights_ = texel_means([this](std::size_t r) { return rows_->weights()[r]; }, coverage);
}

template <class Visit>
void FitSystem::for_each_line(std::span<const float> weights, const Visit& visit) const {
  const Index3 size = texels_->cells();
  const auto layer = [&](int k) {
    for (int j = 0; j < size.y; ++j) {
      wide::FitCells cells = texels_->cells_along(j, k);
      cells.starts = &rows_->starts()[(std::size_t(k) * std::size_t(size.y) + std::size_t(j)) * std::size_t(size.x)];
      cells.rows = rows_->data();
      cells.weights = weights.data();
      visit(cells, std::size_t(k));
    }
  };
  for (int parity = 0; parity < 2; ++parity) {
    const int layers = (size.z - parity + 1) / 2;
    parallel_blocks(std::size_t(layers), 1, run_, "",
                    [&](const Block& block) { layer(parity + 2 * int(block.begin)); });
  }
}

FitVector FitSystem::zero() const {
  return {.numbers = std::vector<float>(texels_->size() * terms().count(), 0.0f), .terms = {}};
}

template <class Value>
std::vector<float> FitSystem::texel_means(const Value& value, std::vector<float>& coverage) const {
  std::vector<float> means(texels_->size(), 0.0f);
  std::vector<double> sum(texels_->size(), 0.0);
  std::vector<double> total(texels_->size(), 0.0);
  for_each_line(rows_->weights(), [&](const wide::FitCells& cells, std::size_t /*layer*/) {
    for (std::size_t c = 0; c < cells.count; ++c) {
      if (cells.starts[c] == cells.starts[c + 1]) continue;
      PerCorner<double> cell_sum{};
      PerCorner<double> cell_total{};
      for (std::size_t r = cells.starts[c]; r < cells.starts[c + 1]; ++r) {
        const PerCorner<float> w = corner_weights(rows_->data()[r].place);
        const auto v = double(value(r));
        for (unsigned q = 0; q < 8; ++q) {
          cell_sum[q] += double(w[q]) * v;
          cell_total[q] += double(w[q]);
        }
      }
      for (unsigned q = 0; q < 8; ++q) {
        const std::size_t t = cells.texels[q >> 1][c] + (cells.has_pairs ? q & 1u : 0);
        sum[t] += cell_sum[q];
        total[t] += cell_total[q];
      }
    }
  });
  coverage.resize(texels_->size());
  for (std::size_t t = 0; t < sum.size(); ++t) {
    coverage[t] = float(total[t]);
    if (total[t] > 0.0) means[t] = float(sum[t] / total[t]);
  }
  return means;
}

FitVector FitSystem::prior(const FitChannel& light, std::vector<float>& coverage) const {
  FitVector x = zero();
  const std::vector<float> means =
      texel_means([&](std::size_t r) { return light.first[rows_->samples()[r] * light.stride]; }, coverage);
  std::copy(means.begin(), means.end(), x.numbers.begin());
  return x;
}

FitRest FitSystem::rest(const FitChannel& light, const FitVector& prior, const FitVector& x, const FitDamping& damping,
                        const ValueRange& bounds) const {
  FitRest rest{.gradient = zero(), .weights = std::vector<float>(rows_->size(), 0.0f)};
  FitVector& y = rest.gradient;
  std::vector<float> moved(prior.numbers);
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += x.numbers[i];
  texels_->move(moved, run_);
  const wide::FitLight of{.light = light.first,
                          .stride = light.stride,
                          .samples = rows_->samples().data(),
                          .low = bounds.low,
                          .high = bounds.high,
                          .clamped_part = kClampedPart};
  std::vector<Terms> layers(std::size_t(texels_->cells().z), Terms{});
  for_each_line(rows_->weights(), [&](const wide::FitCells& cells, std::size_t layer) {
    kernels_.left(cells, of, moved.data(), x.terms, y.numbers.data(), layers[layer], rest.weights.data());
  });
  finish(layers, -1.0f, damping, x, y);
  return rest;
}

void FitSystem::normal_product(const FitVector& x, const FitDamping& damping, std::span<const float> weights,
                               FitVector& y, std::vector<float>& moved) const {
  y.numbers.assign(x.numbers.size(), 0.0f);
  y.terms.fill(0.0);
  moved = x.numbers;
  texels_->move(moved, run_);
  wide::FitTermSums<float> terms{};
  for (std::size_t t = 0; t < kTerms; ++t) terms[t] = float(x.terms[t]);
  std::vector<Terms> layers(std::size_t(texels_->cells().z), Terms{});
  for_each_line(weights, [&](const wide::FitCells& cells, std::size_t layer) {
    kernels_.product(cells, moved.data(), terms, y.numbers.data(), layers[layer]);
  });
  finish(layers, 1.0f, damping, x, y);
}

void FitSystem::finish(const std::vector<Terms>& layers, float sign, const FitDamping& damping, const FitVector& x,
                       FitVector& y) const {
  for (const Terms& layer : layers)
    for (std::size_t t = 0; t < kTerms; ++t) y.terms[t] += layer[t];
  texels_->move_back(y.numbers, run_);
  const std::size_t size = texels_->size();
  parallel_blocks(size, 16384, run_, "", [&](const Block& block) {
    for (std::size_t k = 0; k < terms().count(); ++k) {
      const float held = float(damping[k]);
      for (std::size_t t = block.begin; t < block.end; ++t)
        y.numbers[k * size + t] += sign * (held * texel_weights_[t] * x.numbers[k * size + t]);
    }
  });
}

FitBlocks FitSystem::inverse_blocks(const FitDamping& damping, std::span<const float> weights) const {
  FitBlocks blocks(texels_->size(), terms().count());
  std::vector<FitBlocks::TermBlock> layers(std::size_t(texels_->cells().z), FitBlocks::TermBlock{});
  for_each_line(weights, [&](const wide::FitCells& cells, std::size_t layer) {
    kernels_.moments(cells, texels_->centres(), blocks.plane(0, 0), layers[layer]);
  });
  for (const FitBlocks::TermBlock& layer : layers)
    for (std::size_t s = 0; s < kTerms; ++s)
      for (std::size_t t = 0; t < kTerms; ++t) blocks.terms()[s][t] += layer[s][t];
  for (std::size_t k = 0; k < terms().count(); ++k) {
    float* diagonal = blocks.plane(k, k);
    for (std::size_t n = 0; n < texels_->size(); ++n) diagonal[n] += float(damping[k]) * texel_weights_[n];
  }
  blocks.invert(run_);
  return blocks;
}

}  // namespace isolux
