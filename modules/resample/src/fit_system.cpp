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
using Terms = std::array<double, kTerms>;
static_assert(kTerms == 4, "terms are added beside four corners");

/// Of the mean weight: no sample counts for nothing.
constexpr double kLeastWeight = 1e-3;
/// Of a row's weight where its reading is clamped. None would be Newton's method, whose step knows no bound where all
/// rows around a texel are.
constexpr float kClampedPart = 0.1f;

}  // namespace

FitSystem::FitSystem(const Volume& volume, const SampleSet& samples, const Lattice& texels, const FitTerms& terms,
                     NearFieldUse near_field, const Run& run)
    : terms_(terms), near_field_(near_field), run_(run) {
  sort_rows(volume, samples, texels, run);
  texels_.emplace(volume, texels, starts_, terms, run);
  measure(volume, samples, run);
  weigh_texels();
}

void FitSystem::sort_rows(const Volume& volume, const SampleSet& samples, const Lattice& texels, const Run& run) {
  CellPlaces sorted = sort_by_cells(volume, samples.sites, texels, run);
  starts_ = std::move(sorted.starts);
  rows_.resize(samples.size());
  parallel_blocks(rows_.size(), 65536, run, "", [&](const Block& block) {
    for (std::size_t r = block.begin; r < block.end; ++r) {
      const CellPlace& place = sorted.places[r];
      rows_[r] = {
          .at = {.place = place.in_cell, .feature = {1.0f}}, .openness = {}, .weight = 1.0f, .sample = place.site};
    }
  });
}

void FitSystem::measure(const Volume& volume, const SampleSet& samples, const Run& run) {
  const NearField near_field(volume);
  const double outwards = near_field.outwards(samples.sites);
  for (double& step : steps_) step *= outwards;

  using Sums = std::array<double, kTerms + 1>;
  std::vector<Sums> blocks(block_count(rows_.size(), 4096), Sums{});
  parallel_blocks(rows_.size(), 4096, run, "", [&](const Block& block) {
    Sums& sums = blocks[block.index];
    for (std::size_t r = block.begin; r < block.end; ++r) {
      Row& row = rows_[r];
      const Vec3 position(samples.sites.positions[row.sample]);
      const NearField::Ahead ahead = near_field.ahead(position);
      for (std::size_t a = 0; terms_.normals && a < 3; ++a)
        row.at.feature[terms_.first_normal() + a] = float(ahead.downhill[int(a)]);
      row.weight = float(std::sqrt(ahead.fall));
      sums[kTerms] += double(row.weight);
      if (near_field_ == NearFieldUse::kNone) continue;
      const auto isovalue = double(samples.sites.isovalues[row.sample]);
      for (std::size_t t = 0; t < kTerms; ++t) {
        row.openness[t] = near_field.openness(position, ahead, isovalue, steps_[t]);
        sums[t] += double(row.openness[t]);
      }
    }
  });
  Sums sums{};
  for (const Sums& block : blocks) {
    for (std::size_t t = 0; t <= kTerms; ++t) sums[t] += block[t];
  }
  centre_rows(sums);
  if (!terms_.slopes) return;
  for_each_cell([&](const FitCorners& corners, std::span<const Row> rows, std::size_t first, std::size_t /*layer*/) {
    for (std::size_t r = first; r < first + rows.size(); ++r)
      rows_[r].at.feature[1] = samples.sites.isovalues[rows_[r].sample] - corners.reference;
  });
}

void FitSystem::centre_rows(const std::array<double, kTerms + 1>& sums) {
  const auto count = double(rows_.size());
  const double weight = sums[kTerms] / count;
  for (std::size_t t = 0; t < kTerms; ++t) mean_openness_[t] = sums[t] / count;
  for (Row& row : rows_) {
    for (std::size_t t = 0; t < kTerms; ++t) row.openness[t] -= float(mean_openness_[t]);
    row.weight = weight > 0.0 ? float(std::max(double(row.weight) / weight, kLeastWeight)) : 1.0f;
  }
}

void FitSystem::weigh_texels() {
  std::vector<float> coverage;
  texel_weights_ = texel_means([](const Row& row) { return row.weight; }, coverage);
}

Terms FitSystem::sum_layers(const std::vector<Terms>& layers) const {
  Terms sum{};
  for (const Terms& layer : layers) {
    for (std::size_t t = 0; t < kTerms; ++t) sum[t] += layer[t];
  }
  return sum;
}

template <class Visit>
void FitSystem::for_each_cell(const Visit& visit) const {
  const Index3 size = texels_->cells();
  const auto layer = [&](int k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        const std::size_t cell =
            (std::size_t(k) * std::size_t(size.y) + std::size_t(j)) * std::size_t(size.x) + std::size_t(i);
        const std::span rows(rows_.data() + starts_[cell], starts_[cell + 1] - starts_[cell]);
        if (rows.empty()) continue;
        visit(texels_->corners(i, j, k), rows, std::size_t(starts_[cell]), std::size_t(k));
      }
    }
  };
  for (int parity = 0; parity < 2; ++parity) {
    const int layers = (size.z - parity + 1) / 2;
    parallel_blocks(std::size_t(layers), 1, run_, "",
                    [&](const Block& block) { layer(parity + 2 * int(block.begin)); });
  }
}

FitVector FitSystem::zero() const {
  return {.numbers = std::vector<float>(texels_->size() * terms_.count(), 0.0f), .terms = {}};
}

FitVector FitSystem::damped(const FitDamping& damping, const FitVector* x) const {
  FitVector y = zero();
  for (std::size_t i = 0, t = 0; t < texel_weights_.size(); ++t)
    for (std::size_t k = 0; k < terms_.count(); ++k, ++i)
      y.numbers[i] = float(damping[k]) * texel_weights_[t] * (x == nullptr ? 1.0f : x->numbers[i]);
  return y;
}

template <class Value>
std::vector<float> FitSystem::texel_means(const Value& value, std::vector<float>& coverage) const {
  std::vector<float> means(texels_->size(), 0.0f);
  std::vector<double> sum(texels_->size(), 0.0);
  std::vector<double> total(texels_->size(), 0.0);
  for_each_cell(
      [&](const FitCorners& corners, std::span<const Row> rows, std::size_t /*first*/, std::size_t /*layer*/) {
        for (const Row& row : rows) {
          const PerCorner<float> w = corner_weights(row.at.place);
          for (unsigned q = 0; q < 8; ++q) {
            sum[corners.texel[q]] += double(w[q]) * double(value(row));
            total[corners.texel[q]] += double(w[q]);
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

FitVector FitSystem::prior(std::span<const float> light, std::vector<float>& coverage) const {
  FitVector x = zero();
  const std::vector<float> means = texel_means([light](const Row& row) { return light[row.sample]; }, coverage);
  for (std::size_t t = 0; t < means.size(); ++t) x.numbers[t * terms_.count()] = means[t];
  return x;
}

FitRest FitSystem::rest(std::span<const float> light, const FitVector& prior, const FitVector& x,
                        const FitDamping& damping, const ValueRange& bounds) const {
  FitRest rest{.gradient = damped(damping, &x), .weights = std::vector<float>(rows_.size(), 0.0f)};
  FitVector& y = rest.gradient;
  for (float& number : y.numbers) number = -number;
  FitVector sum = prior;
  for (std::size_t i = 0; i < x.numbers.size(); ++i) sum.numbers[i] += x.numbers[i];
  std::vector<Terms> layers(std::size_t(texels_->cells().z), Terms{});
  for_each_cell([&](const FitCorners& corners, std::span<const Row> rows, std::size_t first, std::size_t layer) {
    const auto texels = corners.gather<double>(terms_, sum.numbers.data());
    CellLight<double> left(terms_.count());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Row& row = rows[r];
      const PerCorner<float> w = corner_weights(row.at.place);
      double read = texels.read(row.at, w);
      for (std::size_t t = 0; t < kTerms; ++t) read += double(row.openness[t]) * x.terms[t];
      const bool follows = read > double(bounds.low) && read < double(bounds.high);
      rest.weights[first + r] = follows ? row.weight : kClampedPart * row.weight;
      const double error =
          double(row.weight) * (double(light[row.sample]) - std::clamp(read, double(bounds.low), double(bounds.high)));
      left.add(row.at, w, error);
      for (std::size_t t = 0; t < kTerms; ++t) layers[layer][t] += double(row.openness[t]) * error;
    }
    corners.scatter(terms_, left, y.numbers.data());
  });
  y.terms = sum_layers(layers);
  return rest;
}

FitVector FitSystem::normal_product(const FitVector& x, const FitDamping& damping,
                                    std::span<const float> weights) const {
  FitVector y = damped(damping, &x);
  std::vector<Terms> layers(std::size_t(texels_->cells().z), Terms{});
  std::array<float, kTerms> terms{};
  for (std::size_t t = 0; t < kTerms; ++t) terms[t] = float(x.terms[t]);
  for_each_cell([&](const FitCorners& corners, std::span<const Row> rows, std::size_t first, std::size_t layer) {
    const auto texels = corners.gather<float>(terms_, x.numbers.data());
    CellLight<float> image(terms_.count());
    Terms term_sums{};
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Row& row = rows[r];
      const PerCorner<float> w = corner_weights(row.at.place);
      std::array<float, kTerms> parts{};
      for (std::size_t t = 0; t < kTerms; ++t) parts[t] = row.openness[t] * terms[t];
      const float read =
          weights[first + r] * (texels.read(row.at, w) + ((parts[0] + parts[1]) + (parts[2] + parts[3])));
      image.add(row.at, w, read);
      for (std::size_t t = 0; t < kTerms; ++t) term_sums[t] += double(row.openness[t]) * double(read);
    }
    for (std::size_t t = 0; t < kTerms; ++t) layers[layer][t] += term_sums[t];
    corners.scatter(terms_, image, y.numbers.data());
  });
  y.terms = sum_layers(layers);
  return y;
}

FitVector FitSystem::diagonal(const FitDamping& damping, std::span<const float> weights) const {
  FitVector d = damped(damping, nullptr);
  std::vector<Terms> layers(std::size_t(texels_->cells().z), Terms{});
  for_each_cell([&](const FitCorners& corners, std::span<const Row> rows, std::size_t first, std::size_t layer) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Row& row = rows[r];
      const float weight = weights[first + r];
      const PerCorner<float> w = corner_weights(row.at.place);
      for (unsigned q = 0; q < 8; ++q) {
        float* to = &d.numbers[std::size_t(corners.texel[q]) * terms_.count()];
        for (std::size_t k = 0; k < terms_.count(); ++k) {
          const float factor = w[q] * corners.factor(terms_, row.at, k, q);
          to[k] += weight * factor * factor;
        }
      }
      for (std::size_t t = 0; t < kTerms; ++t) {
        layers[layer][t] += double(weight) * double(row.openness[t]) * double(row.openness[t]);
      }
    }
  });
  d.terms = sum_layers(layers);
  return d;
}

}  // namespace isolux
